#include "render/bsdf/thin_film.hpp"

#include "scene/exponential.hpp"
#include "scene/trigonometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

namespace microtrace::bsdf {
namespace {

constexpr double kPi = std::numbers::pi;

double square(double x) {
  return x * x;
}

double schlick(double f0, double cosine) {
  const double x = 1 - cosine;
  return f0 + (1 - f0) * square(square(x)) * x;
}

/// The Fourier transform of the CIE color matching functions, as sums of Gaussians, for an optical
/// path in nanometers; in XYZ, with a phase for each.
DVec3 sensitivity(double path, const DVec3& shift) {
  struct Gaussian {
    double value, position, variance;
  };
  constexpr std::array<Gaussian, 3> lobes{{{5.4856e-13, 1.6810e+06, 4.3278e+09},
                                           {4.4201e-13, 1.7953e+06, 9.3046e+09},
                                           {5.2481e-13, 2.2084e+06, 6.6121e+09}}};
  constexpr Gaussian second{9.7470e-14, 2.2399e+06, 4.5282e+09};
  const double phase = 2 * kPi * path * 1e-9;
  const auto at = [phase](const Gaussian& g, double shifted) {
    const double angle = std::fmod(g.position * phase + shifted, 2 * kPi);
    return g.value * std::sqrt(2 * kPi * g.variance) * cos_radians(angle) *
           exponential(-square(phase) * g.variance);
  };
  return DVec3(at(lobes[0], shift.x) + at(second, shift.x), at(lobes[1], shift.y),
               at(lobes[2], shift.z)) /
         1.0685e-7;
}

DVec3 rec709_from_xyz(const DVec3& c) {
  return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
          -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
          0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

}  // namespace

Vec3 thin_film_reflectance(float cosine, float film_ior, float thickness, const Vec3& f0) {
  // A film of zero thickness has no effect.
  const double s = std::clamp(thickness / 0.03, 0.0, 1.0);
  const double ior = 1 + (double{film_ior} - 1) * s * s * (3 - 2 * s);
  const double inner = std::sqrt(std::max(1 - (1 - square(cosine)) / square(ior), 0.0));

  const double outside = schlick(square((ior - 1) / (ior + 1)), cosine);
  const double through = 1 - outside;
  DVec3 base(0), shift(0);
  for (int i = 0; i < 3; ++i) {
    const double root = std::sqrt(std::clamp<double>(f0[i], 0, 0.9999));
    const double base_ior = (1 + root) / (1 - root);
    base[i] = schlick(square((base_ior - ior) / (base_ior + ior)), inner);
    shift[i] = base_ior < ior ? 2 * kPi : kPi;
  }
  const double path = 2 * ior * thickness * inner;
  const DVec3 twice = glm::clamp(outside * base, DVec3(1e-5), DVec3(0.9999));
  const DVec3 r(std::sqrt(twice.x), std::sqrt(twice.y), std::sqrt(twice.z));
  const DVec3 incoherent = square(through) * base / (DVec3(1) - twice);
  DVec3 sum = outside + incoherent, order = incoherent - through;
  for (int m = 1; m <= 2; ++m) {
    order *= r;
    sum += 2.0 * order * rec709_from_xyz(sensitivity(m * path, double(m) * shift));
  }
  return Vec3(glm::clamp(sum, DVec3(0), DVec3(1)));
}

}  // namespace microtrace::bsdf
