#pragma once
/// The parameters of surfaces in lanes. Contains only plain data; see shading_kernels.hpp.

namespace microtrace {

inline constexpr int kShadingLanes = 16;

/// One float per path.
using LaneFloats = float[kShadingLanes];

/// The members of bsdf::Parameters and bsdf::Layers. Kernels read the second group of members only
/// if bsdf::Features require it.
struct alignas(64) SurfaceLanes {
  LaneFloats base_color[3], metallic, roughness, f0[3], f90;

  LaneFloats transmission, eta, diffuse_transmission, diffuse_transmission_color[3];
  LaneFloats anisotropy, along[3];
  LaneFloats film_share, film_ior, film_thickness;
  LaneFloats sheen[3], sheen_roughness, coat, coat_roughness, coat_normal[3];
};

}  // namespace microtrace
