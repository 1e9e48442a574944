#pragma once
namespace microtrace::bsdf {

/// The fraction of the energy lost by single scattering that multiple scattering reflects; `mean`
/// is the mean albedo for F = 1 (C. Kulla and A. Conty, Revisiting physically based shading at
/// Imageworks, 2017).
template <typename Color>
Color multiple_scattering(const Color& f0, float f90, float mean) {
  const Color fresnel = f0 + (Color(f90) - f0) * (1 / 21.0F);
  return fresnel * fresnel * mean / (Color(1) - fresnel * (1 - mean));
}

}  // namespace microtrace::bsdf
