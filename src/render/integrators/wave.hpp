#pragma once
/// Many paths that go on together, a straight part of each at a time, so that their rays make
/// batches.

#include "render/bsdf/frame.hpp"
#include "render/bsdf/scattering.hpp"
#include "render/integrators/shadow_rays.hpp"
#include "render/lights/lighting.hpp"
#include "render/sampling/dimensions.hpp"
#include "render/sampling/sobol.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/path.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace microtrace {

/// One path on its way.
struct PathState {
  sampling::Sobol sobol{};
  std::size_t slot = 0;  ///< in the batch
  Vec3 throughput{1};
  float density = 0;            ///< with which its last direction was chosen; 0: by the camera
  Receiver from{};              ///< the surface that it leaves
  Vec3 absorption{0};           ///< of the medium that it is in, in powers of two per length
  int channel = 3;              ///< of a path through a dispersing medium, 0 to 2; 3: all
  float begin = 0, spread = 0;  ///< the width of what it stands for, at and from its origin
};

/// Large: made once for many batches.
class Wave {
 public:
  /// Follows a path for each ray to its end; at most kRandomBatch.
  void trace(const World& world, const PathOptions& options, std::span<const Ray> rays,
             std::span<const SampleId> ids, std::span<Sample> samples);

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
  /// A ray to a light or on along the path, without origin yet.
  struct Shadow {
    LightSample light;
    Vec3 color;
    std::size_t slot, spawn;
  };
  struct Onward {
    PathState path;
    std::size_t spawn;
  };

  /// What ray i meets, and what becomes of its path.
  void step(std::size_t i);
  /// Gives a path from the camera its width.
  void widen(const Ray& ray, PathState& path) const;
  void escape(const Ray& ray, const PathState& path);
  void ask_light(const Vertex& vertex, const PathState& path);
  void scatter(const Vertex& vertex, const PathState& path);
  /// The channel for which a path goes on through the surface, chosen at random if it is of all.
  [[nodiscard]] int channel_of(const Material& material, const PathState& path) const;
  /// What is left of light when a path of all channels becomes one of one.
  [[nodiscard]] static Vec3 one_channel(const Vertex& vertex, const PathState& path);
  std::size_t spawn(const Vertex& vertex, const Vec3& direction);
  /// Makes the rays of the next step.
  void set_off();

  /// The number of that pair of random numbers at the present vertex.
  [[nodiscard]] std::uint32_t pair(std::uint32_t which) const {
    return sampling::kFirstVertexPair + (depth_ - 1) * sampling::kVertexPairs + which;
  }

  // Of the present batch:
  const World* world_ = nullptr;
  const Shading* shading_ = nullptr;
  const Lighting* lighting_ = nullptr;
  std::uint32_t depth_ = 1;  // straight parts so far, the one under way among them
  std::uint32_t max_depth_ = 1;
  float sample_width_ = 1;  // of a pixel
  ShadowRays shadow_rays_;
  std::size_t count_ = 0;
  std::array<Ray, kRandomBatch> rays_;
  std::array<PathState, kRandomBatch> paths_;
  std::array<std::optional<Hit>, kRandomBatch> hits_;
  std::size_t shadow_count_ = 0, onward_count_ = 0, spawn_count_ = 0;
  std::array<Shadow, kRandomBatch> shadows_;
  std::array<Onward, kRandomBatch> onwards_;
  std::array<Bvh::Spawn, 2 * kRandomBatch> spawns_;
  std::array<std::optional<Vec3>, 2 * kRandomBatch> origins_;
  std::array<Vec3, kRandomBatch> colors_;
  std::array<float, kRandomBatch> alphas_;
};

}  // namespace microtrace
