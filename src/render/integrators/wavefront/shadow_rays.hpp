#pragma once
/// Traces shadow rays and adds the light that arrives.

#include "accel/ray_tracer.hpp"
#include "render/integrators/wavefront/column_list.hpp"
#include "render/integrators/wavefront/path_state.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/media/nested_media.hpp"
#include "render/shading/shading.hpp"
#include "render/shading/transmittance.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/path.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace microtrace {

/// Values of shadow rays in lanes.
struct ShadowLanes {
  const OriginLanes& rays;
  const std::uint32_t* left;
  const std::uint32_t* slots;
  const std::uint32_t* media;
  const LightSamples<kShadingLanes>& samples;
  const LaneFloats (&light)[3];
};

/// A batch of shadow rays.
class ShadowRays {
 public:
  /// Adds the rays in these lanes. There may be at most kRandomBatch rays. All arrays to which
  /// `rays` refers must be at fixed distances from rays.rays.
  void add(const ShadingKernels& kernels, Lanes lanes, const ShadowLanes& rays);

  [[nodiscard]] std::size_t count() const { return free_.count + aimed_.count; }

  /// Traces the rays, adds the light that arrives to the colors, and clears the rays. `media` has
  /// the rays' media. Returns the number of calls of Bvh::next.
  std::uint64_t trace(RayTracer& tracer, const Bvh& bvh, const Shading& shading,
                      const PathOptions& options, NestedMediaTable& media, std::span<Vec3> colors);

 private:
  /// A group of rays that all have a target, or that all have none.
  struct Group {
    std::size_t count = 0;
    ShadowColumns rays;
    ColumnList columns{};  ///< those that add() copies

    void add(const ShadingKernels& kernels, Lanes lanes, const ShadowLanes& from,
             const LaneFloats& t_max);
  };

  Group free_, aimed_;
  LaneFloats t_max_;                            // working memory of add()
  std::array<PrimitiveId, kRandomBatch> hits_;  // working memory
  std::array<PassedTriangles, kRandomBatch> passed_;
};

}  // namespace microtrace
