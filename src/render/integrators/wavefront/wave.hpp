#pragma once
/// A wavefront of paths that advance one bounce at a time, so that rays are traced in batches.

#include "accel/ray_tracer.hpp"
#include "render/integrators/wavefront/path_recorder.hpp"
#include "render/integrators/wavefront/path_state.hpp"
#include "render/integrators/wavefront/shadow_rays.hpp"
#include "render/integrators/wavefront/vertices/vertex_queue.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/lighting/ground_shadows.hpp"
#include "render/lighting/lighting.hpp"
#include "render/media/nested_media.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/path.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace microtrace {

/// A wavefront. This is a large object that is created once for many batches.
class Wave {
 public:
  Wave();

  /// Traces a path to its end for each ray. There may be at most kRandomBatch rays. Adds what the
  /// paths learn to `records` unless it is null.
  void trace(const World& world, const PathOptions& options, std::span<const Ray> rays,
             std::span<const SampleId> ids, std::span<Sample> samples,
             GuideRecords* records = nullptr);

  /// Returns the counts since the last call.
  [[nodiscard]] RayCounts take_counts() { return std::exchange(counts_, {}); }

 private:
  void begin(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids);
  /// Finds the hits of all rays.
  void intersect(std::span<const Ray> camera_rays);
  /// The triangles that rays other than camera rays pass through in places.
  [[nodiscard]] MaskedTriangles masked() const;
  /// Sets the hit of camera path i, which may be kNoPrimitive.
  void set_camera_hit(std::size_t i, PrimitiveId id);
  /// Replaces hits of camera rays at transparent points by the next visible hits.
  void find_visible();
  /// Sets blockers_ for the rays that hit triangles with open backs.
  void find_blocked();
  /// True if path i, which passes through its hit, can do so together with others.
  [[nodiscard]] bool may_continue_later(std::size_t i) const;
  /// Lets path i pass through its hit when all paths have met their next surfaces.
  void continue_later(std::size_t i);
  /// Keeps only the paths that pass through surfaces, and finds their next hits. Returns false if
  /// there are none.
  [[nodiscard]] bool continue_passing();
  /// The hits that don't count for paths that have passed through surfaces.
  [[nodiscard]] HitFilter passed() const;
  /// True if path i has passed through this primitive.
  [[nodiscard]] bool has_passed(std::size_t i, PrimitiveId id) const;
  /// True if the ray of camera path i, which hits this masked primitive, certainly passes it.
  [[nodiscard]] bool is_transparent_to_camera(std::size_t i, const Ray& ray, PrimitiveId id) const;
  /// Advances all paths by one bounce.
  void step();
  /// Advances the paths from `first` on, up to kShadingLanes, by one bounce.
  void step(std::size_t first);
  /// Advances the paths from `first` on that hit something. Returns the lanes of those that leave
  /// the scene nevertheless.
  [[nodiscard]] Lanes meet_surfaces(std::size_t first);
  /// Sets the footprints of the camera paths in the group from `first` on.
  void widen(std::size_t first);
  /// The lanes from `first` on whose paths have their maximum length.
  [[nodiscard]] Lanes last_paths(std::size_t first) const;
  struct MetSurfaces {
    Lanes simple = 0;  ///< vertices without textures that need no further tests
    Lanes ended = 0;   ///< paths that end at surfaces that emit nothing
  };
  /// Sets the surfaces of the group's lanes with flat triangles. Leaves out those that need further
  /// tests.
  [[nodiscard]] MetSurfaces add_flat(std::size_t first);
  /// True if path i needs no further tests where it hits this side of an opaque part of a surface
  /// that emits nothing.
  [[nodiscard]] bool is_simple(std::size_t i, const TexturedMaterial& look, bool is_front) const;
  /// Sets the vertices of the group's lanes whose surfaces need no further tests. Returns these
  /// lanes, those of paths that end at surfaces that emit nothing, and those of passing_ paths.
  [[nodiscard]] Lanes add_simple(std::size_t first);
  struct VaryingSurfaces {
    Lanes opaque = 0;  ///< surfaces that need no further tests, because they emit nothing
    Lanes passed = 0;  ///< blended surfaces through which paths pass
  };
  /// Sets what textures and vertex colors determine in these lanes.
  [[nodiscard]] VaryingSurfaces add_varying(std::size_t first, Lanes lanes);
  /// Sets the alpha from which surfaces with this material stop the paths from `first` on.
  void set_least_alpha(std::size_t first, const TexturedMaterial& look, float covering_alpha);
  /// Advances the path in a lane, which needs further tests. Returns false if the path leaves the
  /// scene.
  [[nodiscard]] bool step_slowly(std::size_t first, int lane);
  /// Moves path i through its medium along its ray. Returns true if the path reaches the hit. If it
  /// is scattered before, adds its next ray.
  [[nodiscard]] bool cross_medium(std::size_t i, const Ray& ray, const std::optional<Hit>& hit,
                                  float distance);
  /// True if path i passes through the surface of a body without noticing it, because it is in
  /// another body that overlaps this one. Remembers the surface until the path moves.
  [[nodiscard]] bool passes_hidden_surface(std::size_t i, const ShadingPoint& point);
  /// Sets the vertex of a lane.
  void put_vertex(std::size_t i, int lane, const Hit& hit, const ShadingPoint& point);

  /// Sets the footprint and the texel address of a point on path i.
  void prepare(std::size_t i, ShadingPoint& point) const;
  /// The number of the pair of random numbers that decides about coverage behind `passed` partially
  /// opaque surfaces.
  [[nodiscard]] std::uint32_t coverage_pair(std::uint32_t passed) const {
    return step_.pair(sampling::kCoveragePair) + passed * sampling::kPassedPairs;
  }
  /// True if the current segment of path i ends at the point. This is a random choice if the point
  /// is partially opaque or clear. `passed` is the number of such surfaces that the path has
  /// passed, and is incremented if it passes this one. Adds clear surfaces to crossed_.
  [[nodiscard]] bool stops(std::size_t i, const ShadingPoint& point, std::uint32_t& passed);
  /// Multiplies the light that path i finds by a factor.
  void weaken(std::size_t i, const Vec3& light);
  /// Finds the next hit of path i behind `hit`, and sets `point` to its shading point.
  [[nodiscard]] std::optional<Hit> next(std::size_t i, const Hit& hit, ShadingPoint& point);
  /// The source of the light that arrives from behind through surfaces whose backs pass light.
  struct Behind {
    bool is_open = false;      ///< true if the source is the environment
    Vec3 light{1};             ///< the factor of its light
    std::optional<Hit> hit{};  ///< the hit if the source is an emissive surface
    ShadingPoint point{};      ///< the hit's shading point
  };
  /// Looks for light from behind if path i's ray hits the front of a one-sided surface. `first`,
  /// `point` and `passed` are the hit, its shading point and the number of surfaces passed before.
  /// `is_nearest` is true if the hit is that of hits_. The result is empty if no light arrives.
  [[nodiscard]] Behind look_behind(std::size_t i, const Hit& first, ShadingPoint point,
                                   std::uint32_t passed, bool is_nearest);
  /// The radiance that the surface emits toward path i. Except for camera rays, emission and
  /// coverage are looked up without a filter, as for light samples and shadow rays, because both
  /// must estimate the same light.
  [[nodiscard]] Vec3 emission(std::size_t i, const ShadingPoint& point) const;
  /// Adds the light that the surface emits toward path i.
  void add_emission(std::size_t i, const Hit& hit, const ShadingPoint& point);
  /// Adds the light of the environment and of the ground that escaped_ paths reach, and clears
  /// escaped_.
  void escape();
  /// Adds the light of the environment that up to kShadingLanes paths reach.
  void add_environment(std::span<const std::uint32_t> escaped);
  /// Finds the y coordinate of the ground, if there is one, in scene coordinates.
  [[nodiscard]] std::optional<float> find_ground() const;
  /// Samples the light at the point where the ray of path i meets the ground, if it does.
  void meet_ground(std::size_t i);
  /// Darkens a camera ray's sample by the occluded fraction of the ground's light.
  void darken(std::size_t slot, float occlusion);
  /// The color channel with which path i continues through the surface. At a dispersive surface, a
  /// path with all channels chooses one at random.
  [[nodiscard]] int channel_of(const Material& material, std::size_t i) const;
  /// True if find_blocked() can be used.
  [[nodiscard]] bool knows_blocked() const {
    return looks_behind() && shading_->triangles_with_open_backs() != nullptr &&
           tracer_.knows_sides();
  }
  /// True if path i, whose first hit is the front of a surface with an open back, may get light
  /// from behind it.
  [[nodiscard]] bool may_get_light(std::size_t i) const {
    return !knows_blocked() || blockers_[i] == kNoPrimitive ||
           !shading_->blocks_unless_transparent(blockers_[i]) ||
           shading_->is_emissive(blockers_[i]);
  }
  /// True if path i has its maximum length.
  [[nodiscard]] bool is_last(std::size_t i) const {
    return step_.depth - paths_->scatterings[i] >= options_.max_depth;
  }
  /// True if paths look behind the fronts of one-sided surfaces.
  [[nodiscard]] bool looks_behind() const {
    return step_.depth > 1 && options_.backfaces == Backfaces::pass && lighting_->may_surround();
  }

  // The state of the current batch.
  RayCounts counts_{};
  const World* world_ = nullptr;
  const Shading* shading_ = nullptr;
  const Lighting* lighting_ = nullptr;
  WaveStep step_;
  PathOptions options_;
  VertexQueues vertices_;
  RayTracer tracer_;
  ShadowRays shadow_rays_;
  NestedMediaTable media_;
  OutgoingRays* outgoing_ = nullptr;  // during a bounce
  /// A hidden or clear surface that the current ray meets.
  struct Crossed {
    float distance;                ///< from the ray's origin
    const Medium* left = nullptr;  ///< the body that the ray leaves if the surface is hidden
    Vec3 light{1};                 ///< the factor of the light that arrives from there
  };
  std::vector<Crossed> crossed_;
  std::optional<float> ground_;
  GroundShadows ground_shadows_;
  PathRecorder recorder_;
  const ShadingKernels* kernels_;
  std::size_t count_ = 0;
  // The paths of this bounce, and those of the next one.
  std::unique_ptr<PathColumns> paths_, next_paths_;
  std::array<PrimitiveId, kRandomBatch> hits_;  // kNoPrimitive for rays without a hit
  std::array<std::optional<Hit>, kRandomBatch> camera_hits_;
  /// The first primitive that blocks the light from behind, or kNoPrimitive. Any primitive if there
  /// are no emissive surfaces.
  std::array<PrimitiveId, kRandomBatch> blockers_;
  /// The number of blended and clear surfaces that the current rays have passed. Paths that pass
  /// more than kMostPassed of them use next().
  std::uint32_t passed_ = 0;
  static constexpr std::uint32_t kMostPassed = 16;
  // These surfaces, by their order along the ray and by slot.
  std::array<std::array<PrimitiveId, kRandomBatch>, kMostPassed> passed_ids_;
  // The paths that pass through another surface.
  std::array<std::uint32_t, kRandomBatch> passing_;
  std::size_t passing_count_ = 0;
  // Working memory of find_visible() and find_blocked().
  RayArrays open_rays_;
  PathFloats open_t_min_;
  std::array<std::size_t, kRandomBatch> open_paths_;
  std::array<PrimitiveId, kRandomBatch> open_blockers_;
  std::array<Vec3, kRandomBatch> colors_;
  std::array<float, kRandomBatch> alphas_;
  TexturedLanes textured_;
  // Paths that leave the scene at this bounce. Few of a group do, so they are collected.
  std::array<std::uint32_t, kRandomBatch> escaped_;
  std::size_t escaped_count_ = 0;
  Lighting::Escapes escapes_;
  // The input of a BSDF with textures. A local variable would be cleared for each vertex.
  std::optional<BsdfInput> varying_;
};

}  // namespace microtrace
