#pragma once
/// Reflectance of thin films.

#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// The reflectance of a film with this index and thickness (nanometers) on a base with reflectance
/// f0 at normal incidence, for light from air; `cosine` is that of the angle of incidence. Linear
/// Rec. 709, each in [0, 1]. (L. Belcour and P. Barla, A practical extension to microfacet theory
/// for the modeling of varying iridescence, 2017, in the form of KHR_materials_iridescence.)
[[nodiscard]] Vec3 thin_film_reflectance(float cosine, float film_ior, float thickness,
                                         const Vec3& f0);

}  // namespace microtrace::bsdf
