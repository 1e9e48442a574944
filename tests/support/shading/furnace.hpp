#pragma once
/// Albedos of BSDFs under uniform white light, estimated by their samples or integrated.

#include "render/sampling/sobol.hpp"
#include "support/pi.hpp"
#include "support/shading/direction_pdf.hpp"
#include "support/shading/scattering.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace microtrace::bsdf {

/// Estimates the directional albedo of a BSDF for the wo with which it was made.
template <class Model>
DVec3 sampled_albedo(const Model& bsdf, std::uint32_t samples) {
  DVec3 sum(0);
  for (std::uint32_t k = 0; k < samples; ++k) {
    const sampling::Sobol sobol(7, k);
    if (const auto s = bsdf.sample(sobol.pair(0), sobol.one(1))) sum += DVec3(s->weight);
  }
  return sum / double(samples);
}

/// Computes the directional albedo by the midpoint rule, without sampling, with `steps` angles per
/// quarter of a circle.
template <class Model>
DVec3 integrated_albedo(const Model& bsdf, int steps) {
  DVec3 sum(0);
  for (int i = 0; i < 2 * steps; ++i) {
    for (int j = 0; j < 2 * steps; ++j) {
      const double theta = (i + 0.5) / steps * kPi / 2, phi = (j + 0.5) / steps * kPi;
      sum += DVec3(bsdf.evaluate(direction(theta, phi)).value) * std::sin(theta);
    }
  }
  return sum * (kPi / 2 / steps) * (kPi / steps);
}

/// Estimates the directional albedo for wo.
inline DVec3 furnace(const Parameters& p, const std::optional<Layers>& layers, const Vec3& wo,
                     std::uint32_t samples, const Vec3& coat_normal = {0, 0, 1}) {
  return sampled_albedo(Scattering(p, layers, wo, coat_normal), samples);
}

/// The maximum albedo. It allows for the remaining noise of the samples.
inline constexpr double kMost = 1.003;

/// The maximum under a coat that is turned from the shading normal.
inline constexpr double kMostUnderTurnedCoat = 1.015;

/// Expects that at most the fraction `loss` of the light is lost, at any angle and roughness.
inline void expect_white(const char* what, Parameters p, const std::optional<Layers>& layers,
                         double loss, double azimuth = 0.3, double most = kMost) {
  for (const float roughness : {0.05F, 0.25F, 0.45F, 0.7F, 1.0F}) {
    p.roughness = roughness;
    for (const double theta : {0.05, 0.5, 0.9, 1.2, 1.4, 1.5}) {
      // Starts with few samples, and uses more if the result is not within the bounds.
      const Vec3 wo = direction(theta, azimuth);
      double white = furnace(p, layers, wo, 1U << 14U).x;
      if (white < 1 - loss || white > 1.001) white = furnace(p, layers, wo, 1U << 17U).x;
      const std::string place =
          std::string(what) + " " + std::to_string(roughness) + " " + std::to_string(theta);
      EXPECT_GT(white, 1 - loss) << place;
      EXPECT_LT(white, most) << place;
    }
  }
}

inline const Parameters kMetal{.base_color = Vec3(1), .metallic = 1};
inline const Parameters kWhite{.base_color = Vec3(1)};

}  // namespace microtrace::bsdf
