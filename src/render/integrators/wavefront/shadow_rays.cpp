#include "render/integrators/wavefront/shadow_rays.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace microtrace {
namespace {

constexpr std::uint32_t kNoTarget = LightSamples<kShadingLanes>::kNoTarget;

/// The end of rays that are aimed at a point of an emissive surface at t = 1. Because of rounding,
/// rays may pass beside the surface, and end behind it. The distance is greater than nearly all
/// errors of float32, so the kernels know which hits are before the end.
constexpr float kBehindTarget = 1 + 0x1p-7F;

}  // namespace

void ShadowRays::Group::add(const ShadingKernels& kernels, Lanes lanes, const ShadowLanes& from,
                            const LaneFloats& t_max) {
  if (lanes == 0) return;
  if (columns.begins(&from.rays)) {
    columns.add(from.rays.origin, rays.o);
    columns.add(from.rays.direction, rays.d);
    columns.add(t_max, rays.t_max);
    columns.add(from.left, rays.left);
    columns.add(from.samples.target, rays.target);
    columns.add(from.slots, rays.slot);
    columns.add(from.media, rays.media);
    columns.add(from.light, rays.light);
  }
  count += columns.append(kernels, {.lanes = lanes, .from = 0, .to = count});
}

void ShadowRays::add(const ShadingKernels& kernels, Lanes lanes, const ShadowLanes& from) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Lanes aimed = 0;
  // Two loops, because compilers vectorize only the first one.
  for (int lane = 0; lane < kShadingLanes; ++lane) {
    const float end = from.samples.target[lane] != kNoTarget ? kBehindTarget : 1.0F;
    // NOLINTNEXTLINE(bugprone-narrowing-conversions): false alarm of clang-tidy 14 about infinity
    t_max_[lane] = from.samples.is_far[lane] != 0 ? kInfinity : end;
  }
  for (int lane = 0; lane < kShadingLanes; ++lane)
    aimed |= Lanes{from.samples.target[lane] != kNoTarget} << lane;
  aimed_.add(kernels, lanes & aimed, from, t_max_);
  free_.add(kernels, lanes & ~aimed, from, t_max_);
}

std::uint64_t ShadowRays::trace(RayTracer& tracer, const Bvh& bvh, const Shading& shading,
                                const PathOptions& options, NestedMediaTable& media,
                                std::span<Vec3> colors) {
  std::uint64_t beyond = 0;
  LightBlockers blockers(tracer, shading, options);
  const auto add = [&](const ShadowColumns& rays, std::size_t i, const Vec3& part) {
    colors[rays.slot[i]] += part * vector_of(rays.light, i);
  };
  const bool passes_blended = blockers.can_pass_blended();
  // The blended triangles that queries of this number of rays pass.
  const auto passed_by = [&](std::size_t rays) {
    const auto passed = std::span(passed_).first(passes_blended ? rays : 0);
    for (PassedTriangles& triangles : passed) triangles.clear();
    return passed;
  };
  // Adds the light of ray i after its query.
  const auto add_light = [&](const ShadowColumns& arrays, const RayColumns& rays, std::size_t i,
                             const std::optional<PrimitiveId>& target) {
    const NestedMedia* here = media.at(arrays.media[i]);
    if (hits_[i] == kNoPrimitive || hits_[i] == target) {
      if (!passes_blended) return add(arrays, i, Vec3(1));
      if (passed_[i].is_complete()) {
        // The query may have found some behind the target first.
        const auto is_before = [&](PrimitiveId id) {
          return hits_[i] == kNoPrimitive || tracer.is_first(rays[i], id, hits_[i]);
        };
        return add(arrays, i, passed_[i].transmittance(is_before));
      }
    } else {
      const bool may_be_beside = target && shading.is_same_emitter(hits_[i], *target);
      // Only media within others hide surfaces.
      const bool may_be_hidden = here != nullptr && here->outer != nullptr;
      if (!may_be_beside && !may_be_hidden && blockers.blocks(hits_[i])) return;
    }
    const Ray ray = rays[i];
    add(arrays, i,
        transmittance(bvh, shading, options, ray, bvh.intersect(ray), target, beyond,
                      {.table = &media, .here = here}));
  };
  const RayColumns free = columns_of(free_.rays, free_.count);
  tracer.any(free, blockers.filter(nullptr, passed_by(free_.count)),
             std::span(hits_).first(free_.count));
  for (std::size_t i = 0; i < free_.count; ++i) add_light(free_.rays, free, i, std::nullopt);
  const RayColumns aimed = columns_of(aimed_.rays, aimed_.count);
  tracer.closest(aimed, blockers.filter(aimed_.rays.target, passed_by(aimed_.count)),
                 std::span(hits_).first(aimed_.count));
  for (std::size_t i = 0; i < aimed_.count; ++i)
    add_light(aimed_.rays, aimed, i, aimed_.rays.target[i]);
  free_.count = aimed_.count = 0;
  return beyond;
}

}  // namespace microtrace
