#pragma once
#include <microtrace/material.hpp>
#include <microtrace/math.hpp>

namespace microtrace {

/// The homogeneous medium that a surface encloses (KHR_materials_volume and
/// KHR_materials_volume_scatter).
struct Medium {
  Vec3 extinction{0};    ///< by absorption and scattering, in powers of two per length
  Vec3 albedo{0};        ///< scattered fraction of the extinction; 0 where there is no extinction
  Vec3 color{0};         ///< approximate color of a thick body by scattering
  float anisotropy = 0;  ///< mean cosine of the scattering angle, in (-1, 1)
  float ior = 1;         ///< index of refraction; a large number if it is infinite
  float dispersion = 0;  ///< 20 / Abbe number

  [[nodiscard]] bool scatters() const { return albedo != Vec3(0); }
  /// The index of refraction for red, green or blue (0 to 2) according to KHR_materials_dispersion;
  /// without dispersion for channel 3.
  [[nodiscard]] float ior_of(int channel) const;
};

/// True if light is refracted at the surface, because both sides differ in their index of
/// refraction (KHR_materials_transmission and KHR_materials_volume).
[[nodiscard]] inline bool refracts(const Material& m) {
  return m.transmission && m.volume && m.volume->thickness > 0;
}

/// True if the surface encloses a medium that light enters by refraction or by diffuse
/// transmission.
[[nodiscard]] inline bool encloses_medium(const Material& m) {
  return refracts(m) || (m.diffuse_transmission && m.volume && m.volume->thickness > 0);
}

/// The medium that a surface of this material encloses, if encloses_medium().
[[nodiscard]] Medium medium_of(const Material& m);

/// The albedo of a single scattering event at which a half-space of the medium has this albedo,
/// which is the color of a thick body. Both are in [0, 1]. This is the fit of C. Kulla and A. Conty
/// (Revisiting physically based shading at Imageworks, 2017) for isotropic scattering, which
/// KHR_materials_volume_scatter prescribes for any anisotropy.
[[nodiscard]] double single_scattering_albedo(double multiple_scattering_albedo);

}  // namespace microtrace
