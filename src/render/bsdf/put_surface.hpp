#pragma once
/// Stores the parameters of one surface in lanes, or returns the surface. The kernels' own
/// translation units must not include this header.

#include "render/bsdf/parameters.hpp"
#include "render/bsdf/surface.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/lanes/surface_lanes.hpp"

namespace microtrace::bsdf {

/// Stores the parameters that all surfaces have.
inline void put_surface(SurfaceLanes& lanes, int lane, const Parameters& p) {
  put(lanes.base_color, lane, p.base_color);
  lanes.metallic[lane] = p.metallic;
  lanes.roughness[lane] = p.roughness;
  put(lanes.f0, lane, p.dielectric.f0);
  lanes.f90[lane] = p.dielectric.f90;
}

/// Stores all other parameters except for the coat's normal.
inline void put_extensions(SurfaceLanes& lanes, int lane, const Parameters& p,
                           const Layers& layers) {
  lanes.transmission[lane] = p.transmission;
  lanes.eta[lane] = p.eta.value_or(1);
  lanes.diffuse_transmission[lane] = p.diffuse_transmission;
  put(lanes.diffuse_transmission_color, lane, p.diffuse_transmission_color);
  lanes.anisotropy[lane] = p.anisotropy;
  put(lanes.along, lane, p.along);
  const ThinFilm<1> film = p.film.value_or(ThinFilm<1>{});
  lanes.film_share[lane] = film.share;
  lanes.film_ior[lane] = film.ior;
  lanes.film_thickness[lane] = film.thickness;
  put(lanes.sheen, lane, layers.sheen);
  lanes.sheen_roughness[lane] = layers.sheen_roughness;
  lanes.coat[lane] = layers.coat;
  lanes.coat_roughness[lane] = layers.coat_roughness;
}

/// Returns the surface with these parameters in the local coordinates of the frame. The coat's
/// normal is in the coordinates in which the frame is given.
inline Surface<1> surface_of(const Parameters& p, const Layers& layers, const Vec3& coat_normal,
                             const Frame<1>& frame) {
  SurfaceLanes lanes{};
  put_surface(lanes, 0, p);
  put_extensions(lanes, 0, p, layers);
  put(lanes.coat_normal, 0, coat_normal);
  return Surface<1>::extended(lanes, 0, frame);
}

}  // namespace microtrace::bsdf
