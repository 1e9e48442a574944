#pragma once
/// Colours of thin films.

#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// What a film of that index and thickness (nanometres) reflects, on a base that reflects f0 head
/// on, of light from air; `cosine` is that of its angle. Linear Rec. 709, each in [0, 1]. (L.
/// Belcour and P. Barla, A practical extension to microfacet theory for the modeling of varying
/// iridescence, 2017, in the form of KHR_materials_iridescence.)
[[nodiscard]] Vec3 thin_film_reflectance(float cosine, float film_ior, float thickness,
                                         const Vec3& f0);

}  // namespace microtrace::bsdf
