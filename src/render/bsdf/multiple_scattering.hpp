#pragma once
#include "simd/vector3.hpp"

namespace microtrace::bsdf {

/// The fraction of the energy lost by single scattering that multiple scattering reflects (C. Kulla
/// and A. Conty, Revisiting physically based shading at Imageworks, 2017). `mean` is the mean
/// albedo for F = 1. `f0` is a color or a number.
template <class Color, class Number>
Color multiple_scattering(const Color& f0, const Number& f90, const Number& mean) {
  const Color fresnel = f0 + (f90 - f0) * (1 / 21.0F);
  return fresnel * fresnel * mean / complement(fresnel * (1 - mean));
}

}  // namespace microtrace::bsdf
