#pragma once
#include "accel/ray_tracer.hpp"
#include "render/media/nested_media.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace microtrace {

/// The media around the origin of a ray. Bodies that the ray entered later hide the surfaces of
/// those that it leaves.
struct AroundRay {
  NestedMediaTable* table = nullptr;
  const NestedMedia* here = nullptr;  ///< null for a vacuum
};

/// What blocks all light along a ray.
class LightBlockers {
 public:
  /// If `passes_backs`, light passes through the backs of one-sided surfaces.
  LightBlockers(const RayTracer& tracer, const Shading& shading, bool passes_backs)
      : shading_(shading),
        open_(passes_backs && tracer.knows_fronts() ? shading.open_fronts() : nullptr),
        may_pass_opaque_(passes_backs && shading.has_open_backs() && open_ == nullptr) {}

  /// The hits that the queries of a RayTracer must find. Unless `targets` is null, ray i must find
  /// its target targets[i], and hits beside it on the same emitter, even where they are
  /// transparent. Valid as long as this object.
  [[nodiscard]] HitFilter filter(const std::uint32_t* targets = nullptr) {
    targets_ = targets;
    return {.open_fronts = open_,
            .masked = {
                .triangles = shading_.masked(), .context = this, .known = known, .passes = passes}};
  }
  /// True if a ray on which such a query has found this primitive transmits no light, unless the
  /// primitive is the target or a hidden surface. Otherwise, transmittance() decides.
  [[nodiscard]] bool blocks(PrimitiveId id) const {
    return !may_pass_opaque_ && shading_.blocks_unless_transparent(id);
  }

 private:
  static bool passes(const void* self, std::size_t i, const Ray& ray, PrimitiveId id) {
    const auto& blockers = *static_cast<const LightBlockers*>(self);
    return !blockers.may_be_target(i, id) && blockers.shading_.is_transparent(ray, id);
  }
  static Visible known(const void* self, std::size_t i, PrimitiveId id, const HitWeights& at) {
    const auto& blockers = *static_cast<const LightBlockers*>(self);
    return blockers.may_be_target(i, id) ? Visible::yes : blockers.shading_.known_visible(id, at);
  }
  [[nodiscard]] bool may_be_target(std::size_t i, PrimitiveId id) const {
    return targets_ != nullptr && shading_.is_same_emitter(id, targets_[i]);
  }

  const Shading& shading_;
  const std::uint32_t* open_;
  bool may_pass_opaque_;  // true if light passes opaque surfaces through which the queries don't
  const std::uint32_t* targets_ = nullptr;
};

/// The fraction of light that passes all surfaces on a ray before its t_max or its target. `hit` is
/// the ray's nearest hit. If `passes_backs`, light passes through the backs of one-sided surfaces.
/// `beyond` counts the calls of Bvh::next.
[[nodiscard]] float transmittance(const Bvh& bvh, const Shading& shading, bool passes_backs,
                                  const Ray& ray, std::optional<Hit> hit,
                                  const std::optional<PrimitiveId>& target, std::uint64_t& beyond,
                                  AroundRay around = {});

}  // namespace microtrace
