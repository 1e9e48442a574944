#include "base/system/float_environment.hpp"
#include "base/system/processors.hpp"
#include "render/prepared/content.hpp"
#include "scene/mesh/missing_tangents.hpp"
#include "scene/validate/check_indices.hpp"

#include <microtrace/prepared_scene.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace microtrace {
namespace {

std::shared_ptr<SharedTables> tables_for(const Scene& scene, const SharedTables* previous) {
  return previous == nullptr ? std::make_shared<SharedTables>()
                             : std::make_shared<SharedTables>(*previous, scene);
}

}  // namespace

PreparedScene::PreparedScene(std::shared_ptr<const Content> content)
    : content_(std::move(content)) {}

PreparedScene::PreparedScene(Scene scene, PrepareOptions options)
    : PreparedScene(std::make_shared<const Scene>(std::move(scene)), std::move(options)) {}

PreparedScene::PreparedScene(std::shared_ptr<const Scene> scene, PrepareOptions options) {
  if (scene == nullptr) throw Error(ErrorKind::usage, "", "there is no scene to prepare");
  check_indices(*scene);
  MemoryAccount memory(options.memory);
  {
    const MemoryScope scope(memory);
    const FloatEnvironment environment;
    scene = with_tangents(std::move(scene));
  }
  auto tables = tables_for(*scene, options.tables.get());
  BvhOptions tree{.fast_build = options.fast_build,
                  .threads = thread_count(options.threads),
                  .previous = options.tables ? options.tables->tree() : nullptr,
                  .max_cost_growth = options.max_cost_growth};
  options.tables.reset();
  content_ =
      std::make_shared<const Content>(std::move(scene), std::move(tree), tables, std::move(memory));
  // Pictures of a scene with points or line segments have trees of their own.
  if (!has_segments(content_->scene())) tables->set_tree(content_->bvh().tree());
}

const Scene& PreparedScene::scene() const {
  return content_->scene();
}

const Bvh& PreparedScene::bvh() const {
  return content_->bvh();
}

std::shared_ptr<const SharedTables> PreparedScene::tables() const {
  return content_->tables();
}

Ray PreparedScene::in_scene(const Ray& ray) const {
  const DVec3& origin = scene().origin;
  if (origin == DVec3(0)) return ray;
  const FloatEnvironment environment;
  Ray result = ray;
  result.o = Vec3(DVec3(ray.o) - origin);
  return result;
}

std::optional<Hit> PreparedScene::intersect(const Ray& ray) const {
  return bvh().intersect(in_scene(ray));
}

std::optional<Hit> PreparedScene::next(const Ray& ray, const Hit& after) const {
  return bvh().next(in_scene(ray), after);
}

bool PreparedScene::occluded(const Ray& ray) const {
  return bvh().occluded(in_scene(ray));
}

namespace {

/// Calls f with the rays, converted to the scene's coordinates.
template <class F>
void with_rays_in_scene(const PreparedScene& scene, std::span<const Ray> rays, const F& f) {
  if (scene.scene().origin == DVec3(0)) return f(rays);
  std::vector<Ray> own;
  own.reserve(rays.size());
  for (const Ray& ray : rays) own.push_back(scene.in_scene(ray));
  f(own);
}

}  // namespace

void PreparedScene::intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
  with_rays_in_scene(*this, rays, [&](std::span<const Ray> own) { bvh().intersect(own, hits); });
}

void PreparedScene::occluded(std::span<const Ray> rays, std::span<bool> results) const {
  with_rays_in_scene(*this, rays, [&](std::span<const Ray> own) { bvh().occluded(own, results); });
}

SurfaceInteraction PreparedScene::surface(const Ray& ray, const Hit& hit) const {
  const FloatEnvironment environment;
  SurfaceInteraction at = interact(bvh().primitives(), in_scene(ray), hit);
  at.p += scene().origin;
  return at;
}

namespace {

/// Stores N components for each hit, starting at index `first` of the output: value(component, i),
/// or `none` for rays without a hit.
template <std::size_t N, class T>
void store(const OutputArray<T>& to, std::size_t first, std::span<const std::optional<Hit>> hits,
           T none, const auto& value) {
  if (to.data == nullptr) return;
  T* at = to.data + static_cast<std::ptrdiff_t>(first) * to.stride;
  for (std::size_t i = 0; i < hits.size(); ++i, at += to.stride) {
    for (std::size_t c = 0; c < N; ++c)
      at[static_cast<std::ptrdiff_t>(c) * to.component_stride] = hits[i] ? value(c, i) : none;
  }
}

}  // namespace

void PreparedScene::surfaces(std::span<const Ray> rays, std::span<const std::optional<Hit>> hits,
                             const SurfaceBuffers& buffers) const {
  with_rays_in_scene(*this, rays,
                     [&](std::span<const Ray> own) { surfaces_in_scene(own, hits, buffers); });
}

void PreparedScene::surfaces_in_scene(std::span<const Ray> rays,
                                      std::span<const std::optional<Hit>> hits,
                                      const SurfaceBuffers& buffers) const {
  const FloatEnvironment environment;
  const SurfaceFinder& finder = content().surface_finder();
  const DVec3 origin = scene().origin;
  const std::array offset{origin.x, origin.y, origin.z};
  const SurfaceParts parts{.n = buffers.n.data != nullptr,
                           .ns = buffers.ns.data != nullptr,
                           .uv = buffers.uv.data != nullptr};
  SurfaceBatch at;
  for (std::size_t first = 0; first < rays.size(); first += kSurfaceLanes) {
    const std::size_t count = std::min(kSurfaceLanes, rays.size() - first);
    const auto own_hits = hits.subspan(first, count);
    finder.find(rays.subspan(first, count), own_hits, parts, at);
    store<3>(buffers.p, first, own_hits, 0.0,
             [&](std::size_t c, std::size_t i) { return at.p[c][i] + offset[c]; });
    const auto store_floats = [&]<std::size_t N>(const OutputArray<float>& to,
                                                 const SurfaceBatch::Values<float>(&values)[N]) {
      store<N>(to, first, own_hits, 0.0F,
               [&](std::size_t c, std::size_t i) { return values[c][i]; });
    };
    store_floats(buffers.n, at.n);
    store_floats(buffers.ns, at.ns);
    store_floats(buffers.barycentrics, at.barycentrics);
    store_floats(buffers.uv, at.uv);
    store<1>(buffers.front, first, own_hits, false,
             [&](std::size_t, std::size_t i) { return at.side[i] > 0; });
    store<1>(buffers.object, first, own_hits, SurfaceBuffers::kNone,
             [&](std::size_t, std::size_t i) { return at.object[i]; });
    store<1>(buffers.primitive, first, own_hits, SurfaceBuffers::kNone,
             [&](std::size_t, std::size_t i) { return at.primitive[i]; });
  }
}

}  // namespace microtrace
