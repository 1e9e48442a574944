#pragma once
#include "accel/ray_tracer.hpp"
#include "render/media/nested_media.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/path.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

/// The media around the origin of a ray. Bodies that the ray entered later hide the surfaces of
/// those that it leaves.
struct AroundRay {
  NestedMediaTable* table = nullptr;
  const NestedMedia* here = nullptr;  ///< null for a vacuum
};

/// The blended and clear triangles that the query of a ray has passed, in ascending order, so that
/// the product of their transmittances doesn't depend on the order in which they were found.
class PassedTriangles {
 public:
  static constexpr std::uint32_t kMost = 16;

  void clear() { count_ = 0; }
  /// Adds a triangle, unless it is known. If there are too many, they are no longer complete.
  void add(PrimitiveId id, const Vec3& transmittance) {
    const std::uint32_t known = std::min(count_, kMost);
    const auto end = ids_.begin() + known, at = std::lower_bound(ids_.begin(), end, id);
    if (at != end && *at == id) return;
    count_ = known + 1;
    if (known == kMost) return;
    const auto factor = factors_.begin() + (at - ids_.begin());
    std::copy_backward(at, end, end + 1);
    std::copy_backward(factor, factors_.begin() + known, factors_.begin() + known + 1);
    *at = id;
    *factor = transmittance;
  }
  [[nodiscard]] bool is_complete() const { return count_ <= kMost; }
  /// The fraction of light that passes all triangles for which counts(id) is true. The triangles
  /// must be complete.
  template <class Counts>
  [[nodiscard]] Vec3 transmittance(const Counts& counts) const {
    Vec3 product(1);
    for (std::uint32_t i = 0; i < count_; ++i)
      if (counts(ids_[i])) product *= factors_[i];
    return product;
  }

 private:
  std::uint32_t count_ = 0;  // greater than kMost if some are missing
  std::array<PrimitiveId, kMost> ids_;
  std::array<Vec3, kMost> factors_;
};

/// True if light passes through the backs of one-sided surfaces.
[[nodiscard]] inline bool passes_backs(const PathOptions& options) {
  return options.backfaces == Backfaces::pass;
}

/// What blocks all light along a ray.
class LightBlockers {
 public:
  LightBlockers(const RayTracer& tracer, const Shading& shading, const PathOptions& options)
      : shading_(shading),
        model_(options.bsdf),
        open_(passes_backs(options) && tracer.knows_sides() ? shading.triangles_with_open_backs()
                                                            : nullptr),
        may_pass_opaque_(passes_backs(options) && shading.has_open_backs() && open_ == nullptr) {}

  /// The hits that the queries of a RayTracer must find. Unless `targets` is null, ray i must find
  /// its target targets[i], and hits beside it on the same emitter, even where they are
  /// transparent. Unless `passed` is empty, ray i also passes blended and clear triangles that
  /// transmit some light, which are added to passed[i]. Valid as long as this object.
  [[nodiscard]] HitFilter filter(const std::uint32_t* targets = nullptr,
                                 std::span<PassedTriangles> passed = {}) {
    targets_ = targets;
    passed_ = passed;
    return {.open = {.triangles = open_},
            .masked = {
                .triangles = shading_.masked(), .context = this, .known = known, .passes = passes}};
  }
  /// True if a ray on which such a query has found this primitive transmits no light, unless the
  /// primitive is the target or a hidden surface. Otherwise, transmittance() decides.
  [[nodiscard]] bool blocks(PrimitiveId id) const {
    if (may_pass_opaque_) return false;
    return shading_.blocks_unless_transparent(id) ||
           (shading_.is_masked(id) && passes_if_partial(id));
  }
  /// True if rays may pass blended or clear triangles.
  [[nodiscard]] bool can_pass_blended() const {
    return !may_pass_opaque_ && shading_.has_blended();
  }

 private:
  static bool passes(const void* self, std::size_t i, const Ray& ray, PrimitiveId id) {
    const auto& blockers = *static_cast<const LightBlockers*>(self);
    if (blockers.may_be_target(i, id)) return false;
    const Vec3 through = blockers.shading_.masked_transmittance(ray, id, blockers.model_);
    const bool passes_all = through == Vec3(1);
    if (passes_all || through == Vec3(0) || !blockers.passes_if_partial(id)) return passes_all;
    blockers.passed_[i].add(id, through);
    return true;
  }
  static Visible known(const void* self, std::size_t i, PrimitiveId id, const HitWeights& at) {
    const auto& blockers = *static_cast<const LightBlockers*>(self);
    if (blockers.may_be_target(i, id)) return Visible::yes;
    const Visible known = blockers.shading_.known_visible(id, at);
    return known == Visible::yes && blockers.passes_if_partial(id) ? Visible::unsure : known;
  }
  [[nodiscard]] bool passes_if_partial(PrimitiveId id) const {
    return !passed_.empty() && shading_.is_blended(id);
  }
  [[nodiscard]] bool may_be_target(std::size_t i, PrimitiveId id) const {
    return targets_ != nullptr && shading_.is_same_emitter(id, targets_[i]);
  }

  const Shading& shading_;
  BsdfModel model_;
  BitPages open_;
  bool may_pass_opaque_;  // true if light passes opaque surfaces through which the queries don't
  const std::uint32_t* targets_ = nullptr;
  std::span<PassedTriangles> passed_;
};

/// The fraction of light that passes all surfaces on a ray before its t_max or its target. `hit` is
/// the ray's nearest hit. `beyond` counts the calls of Bvh::next.
[[nodiscard]] Vec3 transmittance(const Bvh& bvh, const Shading& shading, const PathOptions& options,
                                 const Ray& ray, std::optional<Hit> hit,
                                 const std::optional<PrimitiveId>& target, std::uint64_t& beyond,
                                 AroundRay around = {});

}  // namespace microtrace
