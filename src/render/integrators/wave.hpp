#pragma once
/// A wavefront of paths that advance one bounce at a time, so that rays are traced in batches.

#include "render/integrators/outgoing_rays.hpp"
#include "render/integrators/path_state.hpp"
#include "render/integrators/shadow_rays.hpp"
#include "render/integrators/vertex_queue.hpp"
#include "render/kernels/kernel.hpp"
#include "render/lights/lighting.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/path.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace microtrace {

/// A large object: created once for many batches.
class Wave {
 public:
  Wave();

  /// Traces a path for each ray to its end; at most kRandomBatch.
  void trace(const World& world, const PathOptions& options, std::span<const Ray> rays,
             std::span<const SampleId> ids, std::span<Sample> samples);

  /// The counts since the last call.
  [[nodiscard]] RayCounts take_counts() { return std::exchange(counts_, {}); }

 private:
  void begin(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids);
  /// Sets the point's footprint and texel address.
  void prepare(std::size_t i, ShadingPoint& point);
  /// Whether the path's current segment ends at a point, chosen at random for partial opacity.
  [[nodiscard]] bool stops(const PathState& path, const ShadingPoint& point,
                           std::uint32_t layer) const;
  /// The next hit of path i behind `hit`; updates the point.
  [[nodiscard]] std::optional<Hit> next(std::size_t i, const Hit& hit, ShadingPoint& point);
  /// The source of light that arrives from behind through the surfaces that path i's ray hits.
  struct Behind {
    bool is_open = false;      ///< the environment
    std::optional<Hit> hit{};  ///< an emissive surface
    ShadingPoint point{};      ///< its shading point
  };
  /// Looks for light from behind, if the ray hits the front of a one-sided surface, its layer with
  /// number `layer`. The result is empty if no light arrives.
  [[nodiscard]] Behind look_behind(std::size_t i, const Hit& first, ShadingPoint point,
                                   std::uint32_t layer);
  /// Advances path i, whose ray hits `point`, if anything.
  void step(std::size_t i, ShadingPoint& point);
  /// Advances all paths.
  void step();
  /// Sets the footprint of a camera path.
  void widen(const Ray& ray, PathState& path) const;
  void escape(const Ray& ray, const PathState& path);
  /// The color channel with which a path continues through the surface, chosen at random if it has
  /// all channels.
  [[nodiscard]] int channel_of(const Material& material, const PathState& path) const;

  // State of the current batch:
  RayCounts counts_{};
  const World* world_ = nullptr;
  const Shading* shading_ = nullptr;
  const Lighting* lighting_ = nullptr;
  WaveStep step_;
  PathOptions options_;
  VertexQueues vertices_;
  OutgoingRays outgoing_;
  ShadowRays shadow_rays_;
  const ShadingKernels* kernels_;
  HitLanes hit_lanes_{};
  std::size_t count_ = 0;
  std::array<Ray, kRandomBatch> rays_;
  std::array<PrimitiveId, kRandomBatch> left_;  // by the rays, except for camera rays
  std::array<PathState, kRandomBatch> paths_;
  std::array<std::optional<Hit>, kRandomBatch> hits_;
  std::array<Vec3, kRandomBatch> colors_;
  std::array<float, kRandomBatch> alphas_;
};

}  // namespace microtrace
