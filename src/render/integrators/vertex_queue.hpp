#pragma once
/// Queues of path vertices. The shading kernels process sixteen vertices of the same kind at a
/// time.

#include "render/bsdf/parameters.hpp"
#include "render/integrators/outgoing_rays.hpp"
#include "render/integrators/path_state.hpp"
#include "render/kernels/kernel.hpp"
#include "render/lights/lighting.hpp"
#include "render/shading/shading.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/ray.hpp>

#include <array>
#include <memory>
#include <optional>

namespace microtrace {

/// A path vertex whose light and next direction are to be sampled.
struct Vertex {
  const Ray& ray;
  const Hit& hit;
  const ShadingPoint& point;
  const PathState& path;
  int channel;    ///< color channel for refraction by a dispersive surface; 3 for all channels
  Beyond beyond;  ///< the media below the surface
};

/// The kernel parameters that all paths of a bounce share.
[[nodiscard]] ScatterSetup scatter_setup(const WaveStep& step, const bsdf::Features& features);

/// A queue of vertices on surfaces with the same features.
class VertexQueue {
 public:
  VertexQueue(const bsdf::Features& features, const ShadingKernels& kernels)
      : features_(features), kernels_(kernels) {}

  /// Clears the light samples of the previous scene if this lighting samples no lights.
  void begin(const Lighting& lighting);

  /// Adds a vertex. Its ray and path must remain valid until the bounce is finished.
  void add(const Vertex& vertex, const bsdf::Parameters& parameters, const bsdf::Layers& layers);

  [[nodiscard]] bool is_full() const { return count_ == kShadingLanes; }

  /// Samples light and next directions of all vertices, and empties the queue.
  void finish(const WaveStep& step, const Lighting& lighting, OutgoingRays& outgoing);

 private:
  /// The data of a vertex that are needed to continue its path.
  struct PendingVertex {
    const Ray* ray;
    Hit hit;
    const PathState* path;
    float width;
    int channel;
    const NestedMedia* media;  ///< the media below the surface
  };

  void add_normal_maps(int lane, const ShadingPoint& point);
  void find_frames();
  void sample_lights(const WaveStep& step, const Lighting& lighting);
  /// The fraction of the light sample's light that the medium around the vertex lets through.
  [[nodiscard]] Vec3 light_transmittance(int lane) const;
  void continue_path(int lane, const WaveStep& step, OutgoingRays& outgoing) const;

  bsdf::Features features_;
  const ShadingKernels& kernels_;
  int count_ = 0;
  std::array<PendingVertex, kShadingLanes> pending_{};
  LightChoices<kShadingLanes> light_choices_{};
  TriangleLights<kShadingLanes> triangle_lights_{};
  std::array<LightSample, kShadingLanes> lights_{};
  NormalLanes points_{};
  NormalMapLanes normals_{}, coat_normals_{};
  ScatterLanes scatter_{};
};

/// The queues of all kinds of vertices.
class VertexQueues {
 public:
  VertexQueues();

  void begin(const Shading& shading, const Lighting& lighting);
  void add(const WaveStep& step, const Vertex& vertex, OutgoingRays& outgoing);
  /// Processes the remaining vertices of the bounce.
  void finish(const WaveStep& step, OutgoingRays& outgoing);

 private:
  const ShadingKernels& kernels_;
  const Shading* shading_ = nullptr;
  const Lighting* lighting_ = nullptr;
  std::array<std::unique_ptr<VertexQueue>, bsdf::Features::kCount> queues_;  // by Features::index()
  // The input of a vertex with textures. A local variable would be cleared for each vertex.
  std::optional<BsdfInput> varying_;
};

}  // namespace microtrace
