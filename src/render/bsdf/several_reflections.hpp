#pragma once
namespace microtrace::bsdf {

/// Of light that single reflections do not return, the share that several do; `mean` is the white
/// albedo's (C. Kulla and A. Conty, Revisiting physically based shading at Imageworks, 2017).
template <typename Color>
Color returned_later(const Color& f0, float f90, float mean) {
  const Color fresnel = f0 + (Color(f90) - f0) * (1 / 21.0F);
  return fresnel * fresnel * mean / (Color(1) - fresnel * (1 - mean));
}

}  // namespace microtrace::bsdf
