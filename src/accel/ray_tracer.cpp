#include "accel/ray_tracer.hpp"

#include "accel/bvh_impl.hpp"
#include "accel/kernel_rays.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "accel/resolve/open_side.hpp"
#include "accel/stage_counts.hpp"
#include "base/system/float_environment.hpp"
#include "simd/lane_count.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace microtrace {
namespace {

/// Calls f(part, first) for parts of the rays, from ray `first` on, that a stream can trace.
void for_each_part(const RayColumns& rays, const auto& f) {
  for (std::size_t first = 0; first < rays.count; first += kStreamRays) {
    RayColumns part = rays.from(first);
    part.count = std::min<std::size_t>(part.count, kStreamRays);
    f(part, first);
  }
}

}  // namespace

struct RayTracer::Queries {
  explicit Queries(const Bvh::Impl& impl)
      : bvh(impl), stream(impl.stream_target()), spawns(impl.make_spawns()) {}

  const Bvh::Impl& bvh;
  RayStream stream;
  SpawnBatch spawns;
  std::array<PrimitiveId, SpawnBatch::kHits> left{};
  HitPointLanes* points = nullptr;
};

struct RayTracer::Memory {
  std::optional<Queries> queries{};
};

RayTracer::Queries& RayTracer::queries() const {
  return *memory_->queries;
}

RayTracer::RayTracer() : memory_(std::make_unique<Memory>()) {}
RayTracer::~RayTracer() = default;

void RayTracer::begin(const Bvh& bvh) {
  memory_->queries.emplace(*bvh.impl_);
}

bool RayTracer::knows_sides() const {
  return queries().bvh.knows_sides();
}

OpenSide RayTracer::open_backs(BitPages backs) const {
  return queries().bvh.open_backs(backs);
}

template <class Query>
void RayTracer::trace(const RayColumns& rays, const HitFilter& filter, std::span<PrimitiveId> ids,
                      const Query& query) {
  const FloatEnvironment environment;
  const Bvh::Impl& bvh = queries().bvh;
  const auto ask_one = [&](std::size_t i) {
    const Ray ray = rays[i];
    const std::optional<Hit> hit = bvh.intersect(ray, [&](PrimitiveId id) {
      return meets_open_side(bvh.primitives, filter.open, ray, id) ||
             filter.masked.lets_pass(i, ray, id);
    });
    ids[i] = hit ? hit->id : kNoPrimitive;
  };
  if (!bvh.has_tree) {
    for (std::size_t i = 0; i < rays.count; ++i) ask_one(i);
    return;
  }
  for_each_part(rays, [&](const RayColumns& part, std::size_t first) {
    queries().stream.set_filter(filter, first);
    query(part, ids.subspan(first, part.count), [&](std::size_t i) { ask_one(first + i); });
  });
  queries().stream.set_filter({});
}

void RayTracer::closest(const RayColumns& rays, const HitFilter& filter,
                        std::span<PrimitiveId> ids) {
  trace(rays, filter, ids, [this](const auto&... part) { queries().stream.closest(part...); });
}

void RayTracer::any(const RayColumns& rays, const HitFilter& filter, std::span<PrimitiveId> ids) {
  trace(rays, filter, ids, [this](const auto&... part) { queries().stream.any(part...); });
}

Hit RayTracer::hit(const Ray& ray, PrimitiveId id) const {
  const FloatEnvironment environment;
  const double t_scale = kernel_t_scale(ray);
  return HitResolver(queries().bvh.primitives, ray, t_scale == 0 ? 1 : t_scale).hit(id);
}

bool RayTracer::is_first(const Ray& ray, PrimitiveId id, PrimitiveId other) const {
  const FloatEnvironment environment;
  const HitResolver resolver(queries().bvh.primitives, ray);
  ClosestSoFar nearest = resolver.no_hit();
  resolver.consider(other, nearest);
  resolver.consider(id, nearest);
  return nearest.id == id;
}

void RayTracer::set_hits(std::span<const PrimitiveId> ids, Lanes on_meshes, HitPointLanes& points) {
  const FloatEnvironment environment;
  // The tree holds only one triangle of each group of duplicates.
  const Duplicates& duplicates = queries().bvh.tree.duplicates;
  for (std::size_t i = 0; i < ids.size(); ++i)
    queries().left[i] = duplicates.empty() ? ids[i] : duplicates.representative(ids[i]);
  queries().points = &points;
  queries().spawns.set_hits(std::span(queries().left).first(ids.size()), on_meshes, points);
}

Lanes RayTracer::leave(Lanes wanted, OriginLanes& lanes) {
  const FloatEnvironment environment;
  fallback_stages.origins += static_cast<std::uint64_t>(lane_count(wanted));
  Lanes found = queries().spawns.leave(wanted, lanes);
  for (Lanes open = wanted & ~found; open != 0; open &= open - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(open));
    const Ray ray = ray_of(*queries().points, lane);
    const Vec3 direction(lanes.direction[0][lane], lanes.direction[1][lane],
                         lanes.direction[2][lane]);
    const std::optional<Vec3> origin = queries().bvh.search_origin(
        {.ray = &ray, .hit = {.id = queries().left[lane], .t = 0}, .direction = direction});
    if (!origin) continue;
    for (int axis = 0; axis < 3; ++axis) lanes.origin[axis][lane] = (*origin)[axis];
    found |= Lanes{1} << lane;
  }
  return found;
}

}  // namespace microtrace
