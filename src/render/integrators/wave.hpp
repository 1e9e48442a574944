#pragma once
/// A wavefront of paths that advance one bounce at a time, so that rays are traced in batches.

#include "render/ground/ground_shadows.hpp"
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
#include <vector>

namespace microtrace {

/// A wavefront. This is a large object that is created once for many batches.
class Wave {
 public:
  Wave();

  /// Traces a path to its end for each ray. There may be at most kRandomBatch rays.
  void trace(const World& world, const PathOptions& options, std::span<const Ray> rays,
             std::span<const SampleId> ids, std::span<Sample> samples);

  /// Returns the counts since the last call.
  [[nodiscard]] RayCounts take_counts() { return std::exchange(counts_, {}); }

 private:
  void begin(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids);
  /// Sets the footprint and the texel address of a point on path i.
  void prepare(std::size_t i, ShadingPoint& point);
  /// True if the path's current segment ends at the point. This is a random choice if the point is
  /// partially opaque.
  [[nodiscard]] bool stops(const PathState& path, const ShadingPoint& point,
                           std::uint32_t layer) const;
  /// Finds the next hit of path i behind `hit`, and sets `point` to its shading point.
  [[nodiscard]] std::optional<Hit> next(std::size_t i, const Hit& hit, ShadingPoint& point);
  /// The source of the light that arrives from behind through surfaces whose backs pass light.
  struct Behind {
    bool is_open = false;      ///< true if the source is the environment
    std::optional<Hit> hit{};  ///< the hit if the source is an emissive surface
    ShadingPoint point{};      ///< the hit's shading point
  };
  /// Looks for light from behind if path i's ray hits the front of a one-sided surface. `first`,
  /// `point` and `layer` are the hit, its shading point and the number of its layer. The result is
  /// empty if no light arrives.
  [[nodiscard]] Behind look_behind(std::size_t i, const Hit& first, ShadingPoint point,
                                   std::uint32_t layer);
  /// Moves a path through its medium along its ray. Returns true if the path reaches the hit. If it
  /// is scattered before, adds its next ray.
  bool cross_medium(const Ray& ray, const std::optional<Hit>& hit, float distance, PathState& path);
  /// True if the path passes through the surface of a body without noticing it, because it is in
  /// another body that overlaps this one. Remembers the surface until the path moves.
  bool passes_hidden_surface(const PathState& path, const ShadingPoint& point);
  /// Advances path i by one bounce. `point` is the shading point of its ray's hit, if any.
  void step(std::size_t i, ShadingPoint& point);
  /// Advances all paths by one bounce.
  void step();
  /// Sets the footprint of a camera path.
  void widen(const Ray& ray, PathState& path) const;
  void escape(const Ray& ray, const PathState& path);
  /// Finds the y coordinate of the ground, if there is one, in scene coordinates.
  [[nodiscard]] std::optional<float> find_ground() const;
  /// Samples the light at the point where the ray meets the ground, if it does.
  void meet_ground(const Ray& ray, const PathState& path);
  /// Darkens a camera ray's sample by the occluded fraction of the ground's light.
  void darken(std::size_t slot, float occlusion);
  /// The color channel with which a path continues through the surface. At a dispersive surface, a
  /// path with all channels chooses one at random.
  [[nodiscard]] int channel_of(const Material& material, const PathState& path) const;

  // The state of the current batch.
  RayCounts counts_{};
  const World* world_ = nullptr;
  const Shading* shading_ = nullptr;
  const Lighting* lighting_ = nullptr;
  WaveStep step_;
  PathOptions options_;
  VertexQueues vertices_;
  OutgoingRays outgoing_;
  ShadowRays shadow_rays_;
  std::optional<float> ground_;
  GroundShadows ground_shadows_;
  NestedMediaTable media_;
  /// A body that the current ray leaves through a hidden surface, and the distance of the surface.
  struct LeftBody {
    float distance;
    const Medium* medium;
  };
  std::vector<LeftBody> left_bodies_;
  const ShadingKernels* kernels_;
  HitLanes hit_lanes_{};
  std::size_t count_ = 0;
  std::array<Ray, kRandomBatch> rays_;
  // The primitives that the rays leave; not set for camera rays.
  std::array<PrimitiveId, kRandomBatch> left_;
  std::array<PathState, kRandomBatch> paths_;
  std::array<std::optional<Hit>, kRandomBatch> hits_;
  std::array<Vec3, kRandomBatch> colors_;
  std::array<float, kRandomBatch> alphas_;
};

}  // namespace microtrace
