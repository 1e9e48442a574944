#pragma once
/// Input and output of the kernels for flat triangles. Contains only plain data; see
/// shading_kernels.hpp.

#include "render/lanes/surface_lanes.hpp"

#include <cstdint>

namespace microtrace {

/// A triangle of a mesh without vertex attributes and textures.
struct alignas(64) FlatTriangle {
  /// Bits of `kind`: the surface has a constant BSDF without bsdf::Features and doesn't emit light;
  /// TexturedMaterial::has_back; has_open_back.
  static constexpr std::uint32_t kSimple = 1, kHasBack = 2, kHasOpenBack = 4;

  float corners[3][3]{};      ///< [corner][axis]
  float n[3]{};               ///< unit geometric normal of the front side
  std::uint32_t is_flat = 0;  ///< 1; 0 in the row that stands for other primitives and for none
  std::uint32_t surface = 0;  ///< index of the FlatSurface
  std::uint32_t kind = 0;
  float unused = 0;
};

/// The parameters of a surface without bsdf::Features, as in SurfaceLanes.
struct alignas(64) FlatSurface {
  float base_color[3]{}, metallic = 0, roughness = 0, f0[3]{}, f90 = 0;
  float unused[7]{};
};

/// Hits of flat triangles.
struct alignas(64) FlatHits {
  std::uint32_t rows[kShadingLanes];  ///< indices of the triangles
  // The kernel sets the members below. Sets of lanes have one bit each.
  std::uint32_t surfaces[kShadingLanes];
  LaneFloats is_flat;  ///< 1 or 0, as in FlatTriangle
  std::uint32_t simple, with_back, with_open_back;
};

}  // namespace microtrace
