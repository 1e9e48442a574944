#pragma once
/// Many paths that go on together, a straight part of each at a time, so that their rays make
/// batches.

#include "render/bsdf/frame.hpp"
#include "render/bsdf/scattering.hpp"
#include "render/integrators/departures.hpp"
#include "render/integrators/path_state.hpp"
#include "render/integrators/plain_vertices.hpp"
#include "render/integrators/shadow_rays.hpp"
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

/// Large: made once for many batches.
class Wave {
 public:
  Wave();

  /// Follows a path for each ray to its end; at most kRandomBatch.
  void trace(const World& world, const PathOptions& options, std::span<const Ray> rays,
             std::span<const SampleId> ids, std::span<Sample> samples);

  /// Of the rays since it was last called.
  [[nodiscard]] RayCounts take_counts() { return std::exchange(counts_, {}); }

 private:
  void begin(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids);
  /// Where a path stands.
  struct Vertex {
    const Ray& ray;
    Hit hit;
    const ShadingPoint& point;
    const bsdf::Frame& frame;
    const bsdf::Scattering& bsdf;
    int channel;  ///< for which a dispersing surface bends the path
  };
  /// Gives the point its width and looks for its textures.
  void prepare(std::size_t i, ShadingPoint& point);
  /// Whether the path ends its present part at a point, by chance where not all of it is there.
  [[nodiscard]] bool stops(const PathState& path, const ShadingPoint& point,
                           std::uint32_t layer) const;
  /// What path i's ray meets behind a hit; the point becomes that one's.
  [[nodiscard]] std::optional<Hit> next(std::size_t i, const Hit& hit, ShadingPoint& point);
  /// Where light comes from that arrives through the backs of what path i's ray meets.
  struct Behind {
    bool is_open = false;      ///< the environment
    std::optional<Hit> hit{};  ///< a surface that shines
    ShadingPoint point{};      ///< there
  };
  /// Nothing if none comes. The ray meets the front of a one-sided surface, `layer` of its layers.
  [[nodiscard]] Behind look_behind(std::size_t i, const Hit& first, ShadingPoint point,
                                   std::uint32_t layer);
  /// What becomes of path i, whose ray meets what it meets at `point`, if anything.
  void step(std::size_t i, ShadingPoint& point);
  /// Steps all paths.
  void step();
  /// Gives a path from the camera its width.
  void widen(const Ray& ray, PathState& path) const;
  void escape(const Ray& ray, const PathState& path);
  void ask_light(const Vertex& vertex, const PathState& path);
  void scatter(const Vertex& vertex, const PathState& path);
  /// The channel for which a path goes on through the surface, chosen at random if it is of all.
  [[nodiscard]] int channel_of(const Material& material, const PathState& path) const;
  /// What is left of light when a path of all channels becomes one of one.
  [[nodiscard]] static Vec3 one_channel(const Vertex& vertex, const PathState& path);

  // Of the present batch:
  RayCounts counts_{};
  const World* world_ = nullptr;
  const Shading* shading_ = nullptr;
  const Lighting* lighting_ = nullptr;
  WaveStep step_;
  PathOptions options_;
  PlainVertices plain_;
  Departures departures_;
  ShadowRays shadow_rays_;
  const ShadingKernels* kernels_;
  HitLanes hit_lanes_{};
  std::size_t count_ = 0;
  std::array<Ray, kRandomBatch> rays_;
  std::array<PathState, kRandomBatch> paths_;
  std::array<std::optional<Hit>, kRandomBatch> hits_;
  std::array<Vec3, kRandomBatch> colors_;
  std::array<float, kRandomBatch> alphas_;
};

}  // namespace microtrace
