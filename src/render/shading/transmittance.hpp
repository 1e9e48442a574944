#pragma once
#include "render/media/nested_media.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>

#include <cstdint>
#include <optional>

namespace microtrace {

/// The media around the origin of a ray. Bodies that the ray entered later hide the surfaces of
/// those that it leaves.
struct AroundRay {
  NestedMediaTable* table = nullptr;
  const NestedMedia* here = nullptr;  ///< null for a vacuum
};

/// The fraction of light that passes all surfaces on a ray before its t_max or its target; 0 if the
/// ray misses its target. `hit` is the ray's nearest hit. If `passes_backs`, light passes through
/// the backs of one-sided surfaces. `beyond` counts the calls of Bvh::next.
[[nodiscard]] float transmittance(const Bvh& bvh, const Shading& shading, bool passes_backs,
                                  const Ray& ray, std::optional<Hit> hit,
                                  const std::optional<PrimitiveId>& target, std::uint64_t& beyond,
                                  AroundRay around = {});

}  // namespace microtrace
