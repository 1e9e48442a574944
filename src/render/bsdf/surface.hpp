#pragma once
/// The parameters of BSDFs, for N lanes.
///
/// In local coordinates, z is the shading normal on the side of wo. Directions are unit vectors
/// that point away from the surface. wo points to the previous vertex of the path. wi points to the
/// next one, which may be above or below the surface.

#include "render/bsdf/frame.hpp"
#include "render/bsdf/schlick.hpp"
#include "render/bsdf/thin_film.hpp"
#include "render/lanes/surface_lanes.hpp"

namespace microtrace::bsdf {

/// The least z of wo. Rounding may put wo below the surface.
inline constexpr float kGrazingCosine = 1e-5F;

/// See Parameters and Layers for the meaning of the members.
template <int N>
struct Surface {
  using F = Float<N>;
  using V = Floats3<N>;

  V base_color;
  F metallic, roughness;
  Schlick<N> dielectric;

  F transmission, eta, diffuse_transmission;
  V diffuse_transmission_color;
  F anisotropy;
  Floats2<N> along;
  ThinFilm<N> film;

  V sheen;
  F sheen_roughness, coat, coat_roughness;
  V coat_normal;

  /// Reads only the parameters that all surfaces have.
  static Surface plain(const SurfaceLanes& lanes, int i) {
    Surface s{};
    s.base_color = load3<N>(lanes.base_color, i);
    s.metallic = load<N>(lanes.metallic + i);
    s.roughness = load<N>(lanes.roughness + i);
    s.dielectric = {load3<N>(lanes.f0, i), load<N>(lanes.f90 + i)};
    return s;
  }

  static Surface extended(const SurfaceLanes& lanes, int i, const Frame<N>& frame) {
    Surface s = plain(lanes, i);
    s.transmission = load<N>(lanes.transmission + i);
    s.eta = load<N>(lanes.eta + i);
    s.diffuse_transmission = load<N>(lanes.diffuse_transmission + i);
    s.diffuse_transmission_color = load3<N>(lanes.diffuse_transmission_color, i);
    s.anisotropy = load<N>(lanes.anisotropy + i);
    const V along = frame.to_local(load3<N>(lanes.along, i));
    const F length = square_root<N>(along.x * along.x + along.y * along.y);
    const auto has_direction = length > 0;
    s.anisotropy = has_direction ? s.anisotropy : F{};
    s.along = {has_direction ? along.x / length : all<N>(1),
               has_direction ? along.y / length : F{}};
    s.film = {load<N>(lanes.film_share + i), load<N>(lanes.film_ior + i),
              load<N>(lanes.film_thickness + i)};
    s.sheen = load3<N>(lanes.sheen, i);
    s.sheen_roughness = load<N>(lanes.sheen_roughness + i);
    s.coat = load<N>(lanes.coat + i);
    s.coat_roughness = load<N>(lanes.coat_roughness + i);
    // If the coat's normal is the shading normal, it must be exactly z despite rounding.
    const V n = load3<N>(lanes.coat_normal, i);
    const auto is_shading_normal = is_zero(V(n - frame.n));
    s.coat_normal = select3(is_shading_normal, V{F{}, F{}, all<N>(1)}, frame.to_local(n));
    return s;
  }
};

/// The value f(wo, wi) |cos(theta_i)|, and the pdf of sampling wi, per solid angle.
template <int N>
struct Evaluation {
  Floats3<N> value{};
  Float<N> pdf{};
};

}  // namespace microtrace::bsdf
