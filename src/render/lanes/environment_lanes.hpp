#pragma once
/// Input and output of the kernels that sample environments. Contains only plain data; see
/// shading_kernels.hpp.

#include "render/lanes/guide_lanes.hpp"
#include "render/lanes/map_lanes.hpp"

#include <cstdint>

namespace microtrace {

/// The cells of an EnvironmentGuide for points.
template <int width>
struct alignas(64) EnvironmentCells {
  float part[width];         ///< probability of sampling by visibility
  bool is_any = false;       ///< true if it is positive in any lane
  bool is_uniform = false;   ///< true if the environment is sampled only by visibility
  GuideLanes<width> guides;  ///< wi is working memory of the kernels
};

/// Samples of the environment.
template <int width>
struct alignas(64) EnvironmentSamples {
  EnvironmentCells<width> cells;
  MapLanes<width> independent;  ///< samples that are independent of visibility
  MapLanes<width> visible;      ///< lookups of the directions in cells.guides
  // The kernel split_environment() sets the members below.
  float is_selected[width];    ///< 1 where the environment is sampled
  float by_visibility[width];  ///< 1 where it is sampled by visibility
  /// The lanes of these samples, one bit each.
  std::uint32_t lanes_independent, lanes_by_visibility;
};

}  // namespace microtrace
