#include "render/integrators/shadow_rays.hpp"

#include "render/integrators/column_list.hpp"
#include "render/shading/transmittance.hpp"

#include <bit>
#include <limits>

namespace microtrace {
namespace {

constexpr std::uint32_t kNoTarget = LightSamples<kShadingLanes>::kNoTarget;

}  // namespace

void ShadowRays::Group::add(const ShadingKernels& kernels, Lanes lanes, const ShadowLanes& from,
                            const LaneFloats& t_max) {
  if (lanes == 0) return;
  ColumnList list;
  list.add(from.rays.origin, rays.o);
  list.add(from.rays.direction, rays.d);
  list.add(t_max, rays.t_max);
  list.add(from.left, rays.left);
  list.add(from.samples.target, rays.target);
  list.add(from.slots, rays.slot);
  list.add(from.light, rays.light);
  list.append(kernels, {.lanes = lanes, .from = 0, .to = count});
  count += static_cast<std::size_t>(std::popcount(lanes));
}

void ShadowRays::add(const ShadingKernels& kernels, Lanes lanes, const ShadowLanes& from) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  LaneFloats t_max;
  Lanes aimed = 0;
  for (int lane = 0; lane < kShadingLanes; ++lane) {
    const bool has_target = from.samples.target[lane] != kNoTarget;
    aimed |= Lanes{has_target} << lane;
    // A punctual light is at t = 1. An emissive triangle is hit at about t = 1.
    t_max[lane] = has_target || from.samples.is_far[lane] != 0 ? kInfinity : 1;
  }
  aimed_.add(kernels, lanes & aimed, from, t_max);
  free_.add(kernels, lanes & ~aimed, from, t_max);
}

std::uint64_t ShadowRays::trace(RayTracer& tracer, const Bvh& bvh, const Shading& shading,
                                Backfaces backfaces, std::span<Vec3> colors) {
  const bool passes_backs = backfaces == Backfaces::pass;
  std::uint64_t beyond = 0;
  // False if each surface blocks the light.
  const bool may_pass = !shading.all_cover() || (passes_backs && shading.has_open_backs());
  const bool knows_fronts =
      passes_backs && shading.open_fronts() != nullptr && tracer.knows_fronts();
  // False if only surfaces that are not opaque let light through.
  const bool may_pass_opaque = passes_backs && shading.has_open_backs() && !knows_fronts;
  const auto add = [&](const ShadowColumns& rays, std::size_t i, float part) {
    colors[rays.slot[i]] += part * vector_of(rays.light, i);
  };
  const RayColumns free = columns_of(free_.rays, free_.count);
  tracer.any(free, knows_fronts ? shading.open_fronts() : nullptr,
             std::span(hits_).first(free_.count));
  for (std::size_t i = 0; i < free_.count; ++i) {
    if (hits_[i] == kNoPrimitive) {
      add(free_.rays, i, 1);
    } else if (may_pass_opaque || !shading.is_opaque(hits_[i])) {
      const Ray ray = free[i];
      const std::optional<Hit> hit = bvh.intersect(ray);
      add(free_.rays, i, transmittance(bvh, shading, passes_backs, ray, hit, std::nullopt, beyond));
    }
  }
  const RayColumns aimed = columns_of(aimed_.rays, aimed_.count);
  tracer.closest(aimed, std::span(hits_).first(aimed_.count));
  for (std::size_t i = 0; i < aimed_.count; ++i) {
    const PrimitiveId target = aimed_.rays.target[i];
    if (hits_[i] == target) {
      add(aimed_.rays, i, 1);
    } else if (may_pass && hits_[i] != kNoPrimitive) {
      const Ray ray = aimed[i];
      add(aimed_.rays, i,
          transmittance(bvh, shading, passes_backs, ray, tracer.hit(ray, hits_[i]), target,
                        beyond));
    }
  }
  free_.count = aimed_.count = 0;
  return beyond;
}

}  // namespace microtrace
