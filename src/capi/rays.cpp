#include "base/shared_range.hpp"
#include "base/system/processors.hpp"
#include "base/system/start_threads.hpp"
#include "capi/handles.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace microtrace::capi {
namespace {

/// The number of rays that a thread takes at a time.
constexpr std::size_t kBlock = 8192;

Ray ray_of(const mt_ray& ray) {
  const float* o = ray.origin;
  const float* d = ray.direction;
  return {.o = {o[0], o[1], o[2]}, .t_min = ray.t_min, .d = {d[0], d[1], d[2]}, .t_max = ray.t_max};
}

mt_hit hit_of(const std::optional<Hit>& hit) {
  if (!hit) return {.primitive = MT_NO_HIT, .t = std::numeric_limits<float>::infinity()};
  return {.primitive = hit->id, .t = hit->t};
}

/// Calls f(first, last) for blocks [first, last) that cover [0, count), on several threads.
template <class F>
void for_each_block(std::size_t count, std::uint32_t threads, const F& f) {
  SharedRange blocks(count, kBlock);
  const std::size_t most = (count + kBlock - 1) / kBlock;
  const std::size_t wanted = std::min<std::size_t>(thread_count(threads), most);
  run_on_threads(static_cast<unsigned>(wanted), nullptr, [&] { blocks.take(f); });
  blocks.rethrow();
}

/// A query of an API function, for `count` rays.
struct Query {
  const mt_scene* scene;
  const mt_ray* rays;
  std::size_t count;
  std::uint32_t threads;
};

/// An array of one element per ray.
struct NamedArray {
  const void* first;
  const char* name;
};

/// Checks the arguments of an API function, then calls f(scene, first, last) for blocks of rays.
template <class F>
mt_status for_rays(const Query& query, std::initializer_list<NamedArray> arrays, const F& f) {
  return guarded([&] {
    require(query.scene, "scene");
    if (query.count == 0) return;
    require(query.rays, "rays");
    for (const auto& [first, name] : arrays) require(first, name);
    for_each_block(query.count, query.threads, [&](std::size_t first, std::size_t last) {
      f(query.scene->prepared, first, last);
    });
  });
}

/// Calls f(scene, i) for each ray index i.
template <class F>
mt_status for_each_ray(const Query& query, std::initializer_list<NamedArray> arrays, const F& f) {
  return for_rays(query, arrays, [&](const PreparedScene& s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) f(s, i);
  });
}

/// Calls f(scene, rays, first) for batches of consecutive rays, where `first` is the index of the
/// first ray.
template <class F>
mt_status for_each_batch(const Query& query, NamedArray results, const F& f) {
  const auto answer = [&](const PreparedScene& s, std::size_t first, std::size_t last) {
    std::vector<Ray> own;
    own.reserve(last - first);
    for (std::size_t i = first; i < last; ++i) own.push_back(ray_of(query.rays[i]));
    f(s, std::span<const Ray>(own), first);
  };
  return for_rays(query, {results}, answer);
}

/// Converts a hit from the caller. Throws Error (usage) if the scene does not have the primitive.
Hit known_hit(const PreparedScene& scene, const mt_hit& hit) {
  if (hit.primitive < scene.bvh().primitives().count()) return {.id = hit.primitive, .t = hit.t};
  throw Error(
      ErrorKind::usage, "",
      "a hit names primitive " + std::to_string(hit.primitive) + ", which the scene does not have");
}

mt_surface surface_of(const PreparedScene& scene, const Ray& ray, const Hit& hit) {
  const SurfaceInteraction at = scene.surface(ray, hit);
  mt_surface result{};
  const DVec3 w = at.triangle ? at.triangle->barycentrics : DVec3(0);
  for (int k = 0; k < 3; ++k) {
    result.position[k] = at.p[k];
    result.normal[k] = at.n[k];
    result.shading_normal[k] = at.ns[k];
    result.barycentrics[k] = w[k];
  }
  const DVec2 uv = at.uv(0).value_or(DVec2(0));
  result.uv[0] = uv.x;
  result.uv[1] = uv.y;
  result.object = static_cast<std::uint32_t>(at.object);
  result.primitive = at.primitive;
  result.material = scene.scene().objects.first_of(at.object).material.value_or(MT_NO_MATERIAL);
  result.front = at.front ? 1 : 0;
  return result;
}

}  // namespace
}  // namespace microtrace::capi

using namespace microtrace;
using namespace microtrace::capi;

mt_status mt_intersect(const mt_scene* scene, const mt_ray* rays, size_t count, uint32_t threads,
                       mt_hit* hits) {
  const auto answer = [&](const PreparedScene& s, std::span<const Ray> own, std::size_t first) {
    std::vector<std::optional<Hit>> found(own.size());
    s.intersect(own, found);
    std::ranges::transform(found, hits + first, hit_of);
  };
  return for_each_batch({scene, rays, count, threads}, {hits, "hits"}, answer);
}

mt_status mt_occluded(const mt_scene* scene, const mt_ray* rays, size_t count, uint32_t threads,
                      uint8_t* results) {
  const auto answer = [&](const PreparedScene& s, std::span<const Ray> own, std::size_t first) {
    const auto found = std::make_unique<bool[]>(own.size());
    s.occluded(own, std::span(found.get(), own.size()));
    for (std::size_t i = 0; i < own.size(); ++i) results[first + i] = found[i] ? 1 : 0;
  };
  return for_each_batch({scene, rays, count, threads}, {results, "results"}, answer);
}

mt_status mt_next(const mt_scene* scene, const mt_ray* rays, const mt_hit* after, size_t count,
                  uint32_t threads, mt_hit* hits) {
  const auto answer = [&](const PreparedScene& s, std::size_t i) {
    hits[i] =
        hit_of(after[i].primitive == MT_NO_HIT ? std::nullopt
                                               : s.next(ray_of(rays[i]), known_hit(s, after[i])));
  };
  return for_each_ray({scene, rays, count, threads}, {{after, "after"}, {hits, "hits"}}, answer);
}

mt_status mt_surfaces(const mt_scene* scene, const mt_ray* rays, const mt_hit* hits, size_t count,
                      uint32_t threads, mt_surface* surfaces) {
  const auto answer = [&](const PreparedScene& s, std::size_t i) {
    surfaces[i] = hits[i].primitive == MT_NO_HIT
                      ? mt_surface{}
                      : surface_of(s, ray_of(rays[i]), known_hit(s, hits[i]));
  };
  return for_each_ray({scene, rays, count, threads}, {{hits, "hits"}, {surfaces, "surfaces"}},
                      answer);
}
