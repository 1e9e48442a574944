#pragma once
/// Queues of path vertices. The shading kernels process sixteen vertices of the same kind at a
/// time.

#include "accel/ray_tracer.hpp"
#include "render/integrators/wavefront/column_list.hpp"
#include "render/integrators/wavefront/path_state.hpp"
#include "render/integrators/wavefront/shadow_rays.hpp"
#include "render/integrators/wavefront/vertices/guided_vertices.hpp"
#include "render/integrators/wavefront/vertices/vertex_group.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/lighting/lighting.hpp"
#include "render/media/nested_media.hpp"

#include <array>
#include <cstddef>
#include <memory>

namespace microtrace {

/// The kernel parameters that all paths of a bounce share.
[[nodiscard]] ScatterSetup scatter_setup(const WaveStep& step, const bsdf::Features& features);

/// Where the rays that leave vertices go.
struct OutgoingRays {
  RayTracer& tracer;
  ShadowRays& shadows;
  const NestedMediaTable& media;
  PathColumns& paths;
  std::size_t count = 0;  ///< number of paths
};

/// A queue of vertices on surfaces with the same features.
class VertexQueue {
 public:
  VertexQueue(const bsdf::Features& features, const ShadingKernels& kernels)
      : features_(features), kernels_(kernels) {}

  /// Clears the light samples of the previous scene if this lighting samples no lights.
  void begin(const Lighting& lighting, const PathGuide* guide);

  /// Vertices of a group, and their paths from the path `first` on.
  struct Vertices {
    const VertexGroup& group;
    const PathColumns& paths;
    std::size_t first;
  };
  /// Adds the vertices in these lanes. Returns the lanes for which there was no space.
  [[nodiscard]] Lanes add(Lanes lanes, const Vertices& from);

  [[nodiscard]] bool is_full() const { return count_ == kShadingLanes; }

  /// Samples light and next directions of all vertices, and empties the queue.
  void finish(const WaveStep& step, const Lighting& lighting, OutgoingRays& outgoing);

 private:
  /// List the arrays that add() and continue_paths() copy.
  void list_paths(const PathColumns& paths);
  void list_group(const VertexGroup& group);
  void list_extensions(const VertexGroup& group);
  void list_next(PathColumns& paths);
  void find_frames();
  void sample_lights(const WaveStep& step, const Lighting& lighting);
  /// Reduces the light of the samples in the given lanes by the media around the vertices, and
  /// sets shadow_media_.
  void cross_media(Lanes lanes, const NestedMediaTable& media);
  /// Adds shadow rays for the given lanes.
  void cast_shadows(Lanes lanes, OutgoingRays& outgoing);
  /// Adds the next rays of the paths in the given lanes.
  void continue_paths(Lanes lanes, const WaveStep& step, OutgoingRays& outgoing);

  bsdf::Features features_;
  const ShadingKernels& kernels_;
  int count_ = 0;
  ColumnList from_paths_, from_group_, to_paths_;
  ColumnList from_maps_;        // for lanes with normal maps
  ColumnList from_extensions_;  // for surfaces with features
  HitPointLanes left_{};
  LaneNumbers ids_{}, on_mesh_{}, slots_{}, channels_{}, below_channels_{};
  LaneNumbers media_{}, below_media_{}, shadow_media_{}, scatterings_{};
  LaneFloats widths_{}, spreads_{};
  Lighting::Choices choices_{};
  LightSamples<kShadingLanes> lights_{};
  NormalLanes points_{};
  NormalMapLanes normals_{}, coat_normals_{};
  ScatterLanes scatter_{};
  OriginLanes origins_{};
  const PathGuide* guide_ = nullptr;  ///< null if paths are not guided
  GuidedVertices guided_;
};

/// The queues of all kinds of vertices.
class VertexQueues {
 public:
  VertexQueues();

  /// `guide` is null if paths are not guided.
  void begin(const Lighting& lighting, const PathGuide* guide);
  /// The group from which add() takes vertices.
  [[nodiscard]] VertexGroup& group() { return *group_; }
  /// Adds the vertices of the group, those of the paths from `first` on.
  void add(const WaveStep& step, const PathColumns& paths, std::size_t first,
           OutgoingRays& outgoing);
  /// Processes the remaining vertices of the bounce.
  void finish(const WaveStep& step, OutgoingRays& outgoing);

 private:
  const ShadingKernels& kernels_;
  const Lighting* lighting_ = nullptr;
  const PathGuide* guide_ = nullptr;
  std::unique_ptr<VertexGroup> group_;
  std::array<std::unique_ptr<VertexQueue>, bsdf::Features::kCount> queues_;  // by Features::index()
};

}  // namespace microtrace
