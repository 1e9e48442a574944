#pragma once
/// Reflectance of thin films, for N lanes.

#include "simd/exponential.hpp"
#include "simd/trigonometry.hpp"
#include "simd/vector3.hpp"

#include <numbers>

namespace microtrace::bsdf {

/// A film that covers part of a surface (KHR_materials_iridescence).
template <int N>
struct ThinFilm {
  Float<N> share = all<N>(1);        ///< covered fraction, in [0, 1]
  Float<N> ior = all<N>(1.3F);       ///< at least 1
  Float<N> thickness = all<N>(400);  ///< nanometers

  bool operator==(const ThinFilm&) const requires(N == 1) = default;
};

/// Computes the film's reflectance in float64.
template <int N>
struct FilmTerms {
  using D = Double<N>;
  using V = Doubles3<N>;

  static constexpr double kPi = std::numbers::pi;

  static D square(const D& x) { return x * x; }

  static D schlick(const D& f0, const D& cosine) {
    const D x = 1 - cosine;
    return f0 + (1 - f0) * square(square(x)) * x;
  }

  /// The Fourier transforms of the CIE XYZ color matching functions, approximated by Gaussians.
  /// `path` is the optical path in nanometers, and `shift` the phase shift of each component.
  static V sensitivity(const D& path, const V& shift) {
    struct Gaussian {
      double value, position, variance, width;  // width: sqrt(2 pi variance)
    };
    constexpr Gaussian kX{5.4856e-13, 1.6810e+06, 4.3278e+09, 0x1.42128b7a1d185p+17};
    constexpr Gaussian kY{4.4201e-13, 1.7953e+06, 9.3046e+09, 0x1.d83f2044b7d1cp+17};
    constexpr Gaussian kZ{5.2481e-13, 2.2084e+06, 6.6121e+09, 0x1.8e19038bce35ap+17};
    constexpr Gaussian kSecond{9.7470e-14, 2.2399e+06, 4.5282e+09, 0x1.4971e4334125fp+17};
    const D phase = 2 * kPi * path * 1e-9;
    const auto at = [&](const Gaussian& g, const D& shifted) {
      const D angle = within_revolution<N>(g.position * phase + shifted);
      return g.value * g.width * cos_radians<N>(angle) *
             exponential<N>(-square(phase) * g.variance);
    };
    return V{at(kX, shift.x) + at(kSecond, shift.x), at(kY, shift.y), at(kZ, shift.z)} /
           (D{} + 1.0685e-7);
  }

  static V rec709_from_xyz(const V& c) {
    return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
            -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
            0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
  }

  static V reflectance(const D& cosine, const D& film_ior, const D& thickness, const V& f0) {
    const D zero{}, one = zero + 1;
    // Fades out the effect of very thin films, so that a film of zero thickness has none.
    const D s = clamped(D(thickness / 0.03), zero, one);
    const D ior = 1 + (film_ior - 1) * s * s * (3 - 2 * s);
    const D inner = square_root<N>(larger_of(D(1 - (1 - square(cosine)) / square(ior)), zero));

    const D outside = schlick(square((ior - 1) / (ior + 1)), cosine);
    const D through = 1 - outside;
    V base, shift;
    const auto add_channel = [&](const D& reflectance, D& base_part, D& shift_part) {
      const D root = square_root<N>(clamped(reflectance, zero, zero + 0.9999));
      const D base_ior = (1 + root) / (1 - root);
      base_part = schlick(square((base_ior - ior) / (base_ior + ior)), inner);
      shift_part = base_ior < ior ? zero + 2 * kPi : zero + kPi;
    };
    add_channel(f0.x, base.x, shift.x);
    add_channel(f0.y, base.y, shift.y);
    add_channel(f0.z, base.z, shift.z);
    const D path = 2 * ior * thickness * inner;
    const auto limited = [&](const D& x) { return clamped(x, zero + 1e-5, zero + 0.9999); };
    const V twice{limited(outside * base.x), limited(outside * base.y), limited(outside * base.z)};
    const V r{square_root<N>(twice.x), square_root<N>(twice.y), square_root<N>(twice.z)};
    const V incoherent = square(through) * base / complement(twice);
    V sum = outside + incoherent, order = incoherent - through;
    for (int m = 1; m <= 2; ++m) {
      const D times = zero + m;
      order *= r;
      sum += (zero + 2.0) * order * rec709_from_xyz(sensitivity(times * path, times * shift));
    }
    return {clamped(sum.x, zero, one), clamped(sum.y, zero, one), clamped(sum.z, zero, one)};
  }
};

/// The reflectance of a film for light from air, in linear Rec. 709, with each channel in [0, 1].
/// `f0` is the reflectance of the base at normal incidence, and `cosine` the cosine of the angle of
/// incidence. (L. Belcour and P. Barla, A practical extension to microfacet theory for the modeling
/// of varying iridescence, 2017, in the form of KHR_materials_iridescence.)
template <int N>
Floats3<N> thin_film_reflectance(const Float<N>& cosine, const ThinFilm<N>& film,
                                 const Floats3<N>& f0) {
  constexpr int n = kDoubleLanes<N>;
  alignas(64) float cosines[N], ior[N], thickness[N], base[3][N], result[3][N];
  store<N>(cosines, cosine);
  store<N>(ior, film.ior);
  store<N>(thickness, film.thickness);
  store3<N>(base, 0, f0);
  for (int i = 0; i < N; i += n) {
    const Doubles3<n> reflectance =
        FilmTerms<n>::reflectance(widened<n>(cosines + i), widened<n>(ior + i),
                                  widened<n>(thickness + i), widened3<n>(base, i));
    narrowed3<n>(reflectance, result, i);
  }
  return load3<N>(result, 0);
}

}  // namespace microtrace::bsdf
