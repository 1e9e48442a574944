#include "float_environment.hpp"
#include "render/prepared/content.hpp"
#include "scene/check_indices.hpp"

#include <microtrace/prepared_scene.hpp>
#include <microtrace/threads.hpp>

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
  check_indices(*scene);
  auto tables = tables_for(*scene, options.tables.get());
  BvhOptions tree{.fast_build = options.fast_build,
                  .threads = options.threads != 0 ? options.threads : default_threads(),
                  .previous = options.tables ? options.tables->tree() : nullptr,
                  .max_cost_growth = options.max_cost_growth};
  options.tables.reset();
  content_ = std::make_shared<const Content>(std::move(scene), std::move(tree), tables,
                                             MemoryAccount(options.memory));
  tables->set_tree(content_->bvh().tree());
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

/// Calls f with the rays in the scene's coordinates.
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

/// Stores component c of value i.
template <class T>
void store(const OutputArray<T>& array, std::size_t i, std::size_t c, auto value) {
  if (array.data == nullptr) return;
  array.data[static_cast<std::ptrdiff_t>(i) * array.stride +
             static_cast<std::ptrdiff_t>(c) * array.component_stride] = static_cast<T>(value);
}

template <class T, glm::length_t n>
void store_vector(const OutputArray<T>& array, std::size_t i, const glm::vec<n, double>& value) {
  for (glm::length_t c = 0; c < n; ++c) store(array, i, static_cast<std::size_t>(c), value[c]);
}

}  // namespace

void PreparedScene::surfaces(std::span<const Ray> rays, std::span<const std::optional<Hit>> hits,
                             const SurfaceBuffers& buffers) const {
  const FloatEnvironment environment;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    std::optional<SurfaceInteraction> at;
    if (hits[i]) at = surface(rays[i], *hits[i]);
    store_vector(buffers.p, i, at ? at->p : DVec3(0));
    store_vector(buffers.n, i, at ? at->n : DVec3(0));
    store_vector(buffers.ns, i, at ? at->ns : DVec3(0));
    store_vector(buffers.barycentrics, i,
                 at && at->triangle ? at->triangle->barycentrics : DVec3(0));
    store_vector(buffers.uv, i, at ? at->uv(0).value_or(DVec2(0)) : DVec2(0));
    store(buffers.front, i, 0, at && at->front);
    store(buffers.object, i, 0, at ? at->object : SurfaceBuffers::kNone);
    store(buffers.primitive, i, 0, at ? at->primitive : SurfaceBuffers::kNone);
  }
}

}  // namespace microtrace
