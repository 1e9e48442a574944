#pragma once
/// The nodes of light trees. Contains only plain data; see shading_kernels.hpp.

#include <cstdint>

namespace microtrace {

/// A node of the light tree, in the tree's own units (LightTreeSpace). Nodes are plain data,
/// because the kernels of all instruction sets share them.
struct alignas(64) LightNode {
  float center[3];  ///< center of the bounding box
  float radius;     ///< radius of the box's bounding sphere
  float power;
  float cos_o;  ///< cosine of half the opening angle of the cone of normals; -1 for all directions
  std::uint32_t children = 0;  ///< index of the first of two adjacent children; 0 for leaves
  std::uint32_t light = 0;     ///< index of the light in a leaf

  /// The cone of normals, which is not used if it contains all directions.
  struct alignas(32) Cone {
    float axis[3];  ///< of unit length
    float sin_o;
    float cos_e;         ///< cosine of the greatest angle to its normal at which a light emits
    float is_two_sided;  ///< 1 if the lights also emit around -axis
  } cone;
};

/// The units of a light tree. Lengths are multiples of its size and powers multiples of its total
/// power, so that float32 can represent squares of lengths. Points far away are moved closer, and
/// small numbers are replaced by kLeast.
struct LightTreeSpace {
  float origin[3] = {0, 0, 0};
  float scale = 1;  ///< a power of two
  double unit = 1;  ///< importance of 1 in world units: power / squared length

  static constexpr float kFarthest = 0x1p60F, kLeast = 0x1p-100F;
};

}  // namespace microtrace
