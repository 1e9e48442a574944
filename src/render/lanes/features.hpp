#pragma once
/// The kinds of BSDFs. All lanes of a kernel call have the same kind.

#include <cstdint>

namespace microtrace::bsdf {

/// The sides of a surface on which it has layers.
enum class LayerSide : std::uint8_t {
  none,
  both,   ///< on both sides of a thin wall
  above,  ///< on the side of wo
  below,
};

/// The parts of a BSDF beyond metallic-roughness. This is plain data, because the kernels of all
/// instruction sets share it.
struct Features {
  bool is_anisotropic = false, has_film = false;
  bool transmits = false;  ///< light may cross the surface
  bool refracts = false;   ///< light that crosses the surface is refracted
  LayerSide layers = LayerSide::none;
  /// The formulas of the glTF specification (BsdfModel::spec). All surfaces of a picture have the
  /// same value.
  bool is_spec = false;

  static constexpr int kCount = 64;
  /// A unique number below kCount for each combination of the features above except is_spec; 0 if
  /// there are none.
  [[nodiscard]] int index() const {
    return int{is_anisotropic} + 2 * int{has_film} + 4 * int{transmits} + 8 * int{refracts} +
           16 * static_cast<int>(layers);
  }
};

/// No features, as a compile-time constant.
struct PlainFeatures {
  static constexpr bool is_anisotropic = false, has_film = false, transmits = false,
                        refracts = false, is_spec = false;
  static constexpr LayerSide layers = LayerSide::none;
};

/// The cosine with the shading normal above which a surface reflects. The coat of an opaque surface
/// may have another normal, so it also reflects to directions below the shading normal's horizon.
template <class FeaturesType>
constexpr float least_reflected_cosine(const FeaturesType& features) {
  return features.layers != LayerSide::none && !features.transmits ? -1 : 0;
}

}  // namespace microtrace::bsdf
