#pragma once
#include "simd/vector3.hpp"

namespace microtrace::bsdf {

/// The parameters that all surfaces have, except for the reflectance of dielectrics.
template <int N>
struct BaseSurface {
  Floats3<N> color;  ///< linear Rec. 709, each in [0, 1]
  Float<N> metallic, roughness;

  /// `product` is that of the material's base color, the vertex color and the texel. The green
  /// and the blue channel of the metallic-roughness texture scale roughness and metalness (glTF
  /// 2.0, section 3.9.2).
  template <class Material>
  BaseSurface(const Floats3<N>& product, const Material& material, const Float<N>& green,
              const Float<N>& blue)
      : color{in_unit(product.x), in_unit(product.y), in_unit(product.z)},
        metallic(material.metallic * blue),
        roughness(material.roughness * green) {}

 private:
  static Float<N> in_unit(const Float<N>& x) { return clamped(x, Float<N>{}, all<N>(1)); }
};

}  // namespace microtrace::bsdf
