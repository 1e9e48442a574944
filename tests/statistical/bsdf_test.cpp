#include "render/bsdf/bsdf.hpp"

#include "render/sampling/sobol.hpp"
#include "support/chi_square.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace::bsdf {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 direction(double theta, double phi = 0.3) {
  return Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
}

/// The share of white light from all around that goes to wo, by the sampler's weights.
DVec3 reflected(const Bsdf& bsdf, std::uint32_t samples) {
  DVec3 sum(0);
  for (std::uint32_t k = 0; k < samples; ++k) {
    const sampling::Sobol sobol(7, {.x = 0, .y = 0, .index = k});
    if (const auto s = bsdf.sample(sobol.pair(0), sobol.one(1))) sum += DVec3(s->weight);
  }
  return sum / double(samples);
}

/// The same by the midpoint rule, without the sampler.
DVec3 integrated(const Bsdf& bsdf, int steps) {
  DVec3 sum(0);
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < 2 * steps; ++j) {
      const double theta = (i + 0.5) / steps * kPi / 2, phi = (j + 0.5) / steps * kPi;
      sum += DVec3(bsdf.evaluate(direction(theta, phi)).value) * std::sin(theta);
    }
  }
  return sum * (kPi / 2 / steps) * (kPi / steps);
}

TEST(Bsdf, WhiteMetalReturnsAllLight) {
  for (const float roughness : {0.05F, 0.2F, 0.35F, 0.5F, 0.7F, 0.85F, 1.0F}) {
    for (const double theta : {0.0, 0.4, 0.8, 1.1, 1.4}) {
      const Bsdf bsdf({.base_color = Vec3(1), .metallic = 1, .roughness = roughness},
                      direction(theta));
      EXPECT_NEAR(reflected(bsdf, 1U << 14U).x, 1, 0.003) << roughness << ' ' << theta;
    }
  }
}

TEST(Bsdf, SamplerAndQuadratureAgree) {
  for (const float roughness : {0.3F, 0.6F, 1.0F}) {
    for (const float metallic : {0.0F, 0.5F, 1.0F}) {
      for (const double theta : {0.1, 0.7, 1.3}) {
        const Bsdf bsdf(
            {.base_color = {0.9F, 0.5F, 0.1F}, .metallic = metallic, .roughness = roughness},
            direction(theta));
        const DVec3 a = reflected(bsdf, 1U << 14U), b = integrated(bsdf, 300);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(a[c], b[c], 0.004) << roughness << ' ' << metallic << ' ' << theta;
      }
    }
  }
}

TEST(Bsdf, WhiteDielectricReturnsAllLight) {
  for (const float roughness : {0.1F, 0.4F, 0.7F, 1.0F}) {
    for (const double theta : {0.0, 0.6, 1.2, 1.5}) {
      const Bsdf bsdf({.base_color = Vec3(1), .metallic = 0, .roughness = roughness},
                      direction(theta));
      EXPECT_NEAR(reflected(bsdf, 1U << 14U).x, 1, 0.003) << roughness << ' ' << theta;
    }
  }
}

TEST(Bsdf, NeverReturnsMoreThanComes) {
  for (const float roughness : {0.0F, 0.1F, 0.4F, 0.7F, 1.0F}) {
    for (const float metallic : {0.0F, 0.3F, 1.0F}) {
      for (const double theta : {0.0, 0.6, 1.2, 1.5}) {
        const Bsdf bsdf({.base_color = Vec3(1), .metallic = metallic, .roughness = roughness},
                        direction(theta));
        EXPECT_LE(reflected(bsdf, 1U << 13U).x, 1.004)
            << roughness << ' ' << metallic << ' ' << theta;
      }
    }
  }
}

TEST(Bsdf, IsReciprocal) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0.01, 1);
  for (int i = 0; i < 2000; ++i) {
    const Parameters p{.base_color = Vec3(u(random), u(random), u(random)),
                       .metallic = float(u(random)),
                       .roughness = float(u(random))};
    const Vec3 a = direction(std::acos(u(random)), 6 * u(random));
    const Vec3 b = direction(std::acos(u(random)), 6 * u(random));
    const Vec3 forth = Bsdf(p, a).evaluate(b).value / b.z,
               back = Bsdf(p, b).evaluate(a).value / a.z;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(forth[c], back[c], 2e-4F * (forth[c] + 0.01F));
  }
}

// Directions in cells of equal cos(theta) and phi against the integral of the density.
TEST(Bsdf, SamplesHaveTheirDensity) {
  constexpr int rows = 12, columns = 16, fine = 24;
  constexpr int samples = 200000;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(0, 1);
  for (const float roughness : {0.25F, 0.5F, 1.0F}) {
    for (const float metallic : {0.0F, 1.0F}) {
      for (const double theta : {0.2, 1.2}) {
        const Bsdf bsdf({.base_color = Vec3(0.6F), .metallic = metallic, .roughness = roughness},
                        direction(theta));
        std::vector<double> counts(rows * columns + 1), expected(rows * columns + 1);
        for (int i = 0; i < samples; ++i) {
          const auto s = bsdf.sample({u(random), u(random)}, u(random));
          if (!s) {
            ++counts.back();
            continue;
          }
          double phi = std::atan2(s->wi.y, s->wi.x) / (2 * kPi);
          phi -= std::floor(phi);
          const int row = std::min(int(s->wi.z * rows), rows - 1);
          ++counts[std::size_t(row * columns + std::min(int(phi * columns), columns - 1))];
        }
        double within = 0;
        for (int cell = 0; cell < rows * columns; ++cell) {
          double sum = 0;
          for (int i = 0; i < fine; ++i) {
            for (int j = 0; j < fine; ++j) {
              const double z = (cell / columns + (i + 0.5) / fine) / rows;
              const double phi = 2 * kPi * (cell % columns + (j + 0.5) / fine) / columns;
              sum += bsdf.evaluate(direction(std::acos(z), phi)).density;
            }
          }
          const double mass = sum / (fine * fine) * 2 * kPi / (rows * columns);
          expected[std::size_t(cell)] = mass * samples;
          within += mass;
        }
        expected.back() = std::max(1 - within, 0.0) * samples;
        EXPECT_LT(chi_square_excess(counts, expected), 5)
            << roughness << ' ' << metallic << ' ' << theta;
      }
    }
  }
}

}  // namespace
}  // namespace microtrace::bsdf
