#pragma once
/// Input and output of the kernels that sample lights. Contains only plain data; see
/// shading_kernels.hpp.

#include "render/lanes/light_node.hpp"
#include "render/lanes/surface_lanes.hpp"

#include <cstdint>

namespace microtrace {

/// The lights among which a kernel selects by their importance at a point. Estimated upper bounds
/// of irradiance are in the units of the near lights' tree.
struct LightChoiceSetup {
  /// Nodes of the near lights' tree; null if there are no near lights.
  const LightNode* nodes = nullptr;
  LightTreeSpace space{};
  bool has_far = false;
  float environment_light = 0, far_light = 0;

  /// Converts an irradiance from world units. A positive one remains positive.
  [[nodiscard]] float irradiance(double light) const;
};

enum class LightKind : std::int32_t { none, environment, far, near };

/// The points for which lights are selected.
template <int width>
struct alignas(width * sizeof(float)) LightChoices {
  float p[3][width], n[3][width];  ///< points, and their unit normals on either side
  float share[width];              ///< factor of LightChoiceSetup::environment_light
  float choice[width];  ///< random number in [0, 1); the kernel rescales it to [0, 1) unless no
                        ///< kind is selected
  // The kernel sets the members below.
  LightKind kind[width];
  float probability[width];    ///< selection probability of the environment, the far lights or the
                               ///< near light
  std::uint32_t light[width];  ///< index among the near lights
};

/// Light samples, in the form of LightSample.
template <int width>
struct alignas(width * sizeof(float)) LightSamples {
  static constexpr std::uint32_t kNoTarget = ~0U;

  float is_far[width];  ///< 1 if to_light is only a direction, otherwise 0
  float to_light[3][width], wi[3][width];
  float light[3][width];  ///< 0 if there is no sample
  float pdf[width];
  std::uint32_t target[width];  ///< the emissive surface, or kNoTarget
};

/// An emissive triangle of a mesh.
struct alignas(64) TriangleLight {
  float corners[3][3];        ///< [corner][axis]
  float emission[3];          ///< of the front; unused if it is not the same everywhere
  float has_back;             ///< 1 if the back emits too, otherwise 0
  std::uint32_t id;           ///< PrimitiveId
  std::uint32_t is_textured;  ///< 1 if the emission is not the same everywhere
};

/// A punctual light of the scene.
struct PunctualLight {
  double position[3];
  /// The axis of a spot light; the direction to a directional light; 0 for point lights.
  double axis[3];
  /// The cosine of a spot light's outer angle, and the difference to that of the inner angle. -1
  /// and 1 for other lights.
  double outer_cosine, penumbra;
  double color[3], intensity;
  double range;           ///< of the falloff window; may be infinite
  double is_directional;  ///< 1 or 0
};

/// The points for which punctual lights are sampled.
template <int width>
struct alignas(width * sizeof(float)) PunctualChoices {
  std::uint32_t light[width];  ///< index into the array of PunctualLight
  float selected[width];       ///< 1 in the lanes to sample, otherwise 0
  /// Among how many lights the light was selected with equal probability, after the selection with
  /// LightChoices::probability.
  float group_size[width];
};

/// The points for which emissive triangles are sampled.
template <int width>
struct alignas(width * sizeof(float)) TriangleChoices {
  float u[2][width];
  std::uint32_t triangle[width];  ///< index into the array of TriangleLight
  float selected[width];          ///< 1 in the lanes to sample, otherwise 0
  /// Values at the sampled point of textured triangles, as seen from the front.
  float emission[3][width], coverage[width];
};

}  // namespace microtrace
