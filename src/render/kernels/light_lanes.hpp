#pragma once
/// Input and output of the kernels that sample lights. Contains only plain data; see kernel.hpp.

#include "render/kernels/surface_lanes.hpp"
#include "render/lights/light_node.hpp"

#include <cstdint>

namespace microtrace {

/// The lights among which a kernel selects by their importance at a point.
struct LightChoiceSetup {
  /// Nodes of the near lights' tree; null if there are no near lights.
  const LightNode* nodes = nullptr;
  bool has_far = false;
  double environment_light = 0, far_light = 0;  ///< estimated upper bounds of irradiance
};

enum class LightKind : std::uint8_t { none, environment, far, near };

/// The points for which lights are selected.
template <int width>
struct alignas(width * sizeof(float)) LightChoices {
  float p[3][width], n[3][width];  ///< points, and their unit normals on either side
  float share[width];              ///< factor of LightChoiceSetup::environment_light
  float choice[width];  ///< random number in [0, 1); the kernel rescales it to [0, 1) unless no
                        ///< kind is selected
  // The kernel sets the members below.
  LightKind kind[width];
  double probability[width];   ///< selection probability of the environment, the far lights or the
                               ///< near light
  std::uint32_t light[width];  ///< index among the near lights
};

/// Samples of emissive triangles, in the form of LightSample.
template <int width>
struct alignas(width * sizeof(float)) TriangleLights {
  float p[3][width];           ///< the illuminated point
  float corners[3][3][width];  ///< [corner][axis]
  float u[2][width];
  /// Values at the sampled point, as seen from the front.
  float emission[3][width], coverage[width];
  float has_back[width];      ///< 1 if the back emits too, otherwise 0
  double probability[width];  ///< selection probability of the triangle
  // The kernel sets the members below.
  float is_far[width];  ///< 1 if to_light is only a direction, otherwise 0
  float to_light[3][width], wi[3][width], light[3][width];
  float pdf[width];  ///< 0 if the triangle contributes no light
};

}  // namespace microtrace
