#include "render/sampling/sobol.hpp"
#include "support/pi.hpp"
#include "support/shading/direction_pdf.hpp"
#include "support/shading/furnace.hpp"
#include "support/shading/scattering.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace::bsdf {
namespace {

TEST(Bsdf, WhiteMetalConservesEnergy) {
  for (const float roughness : {0.05F, 0.2F, 0.35F, 0.5F, 0.7F, 0.85F, 1.0F}) {
    for (const double theta : {0.0, 0.4, 0.8, 1.1, 1.4}) {
      const Scattering bsdf({.base_color = Vec3(1), .metallic = 1, .roughness = roughness},
                            direction(theta));
      EXPECT_NEAR(sampled_albedo(bsdf, 1U << 14U).x, 1, 0.003) << roughness << ' ' << theta;
    }
  }
}

TEST(Bsdf, SamplerAndQuadratureAgree) {
  for (const float roughness : {0.3F, 0.6F, 1.0F}) {
    for (const float metallic : {0.0F, 0.5F, 1.0F}) {
      for (const double theta : {0.1, 0.7, 1.3}) {
        const Scattering bsdf(
            {.base_color = {0.9F, 0.5F, 0.1F}, .metallic = metallic, .roughness = roughness},
            direction(theta));
        const DVec3 a = sampled_albedo(bsdf, 1U << 14U), b = integrated_albedo(bsdf, 300);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(a[c], b[c], 0.004) << roughness << ' ' << metallic << ' ' << theta;
      }
    }
  }
}

TEST(Bsdf, NoSampleOfDarkSurfacesHasALargeWeight) {
  for (const auto& [color, metallic] : {std::pair{Vec3(0, 0, 0.13F), 0.0F},
                                        {Vec3(0.009F), 0.0F},
                                        {Vec3(1e-4F), 0.0F},
                                        {Vec3(0.9F), 0.99F},
                                        {Vec3(0.9F), 0.9999F},
                                        {Vec3(0.9F), 1.0F}}) {
    for (const float roughness : {0.0F, 0.1F, 0.4F}) {
      for (const double theta : {0.1, 0.7, 1.2}) {
        const Scattering bsdf({.base_color = color, .metallic = metallic, .roughness = roughness},
                              direction(theta));
        float most = 0;
        for (std::uint32_t k = 0; k < 1U << 14U; ++k) {
          const sampling::Sobol sobol(7, k);
          if (const auto s = bsdf.sample(sobol.pair(0), sobol.one(1)))
            most = std::max({most, s->weight.x, s->weight.y, s->weight.z});
        }
        EXPECT_LT(most, 4) << color.z << ' ' << metallic << ' ' << roughness << ' ' << theta;
      }
    }
  }
}

TEST(Bsdf, SamplesOfMatteSurfacesHaveEqualWeights) {
  const Vec3 color(0.9F, 0.5F, 0.1F);
  for (const float roughness : {0.1F, 1.0F}) {
    const Scattering bsdf(
        {.base_color = color, .roughness = roughness, .dielectric = {Vec3(0), 0.0F}},
        direction(0.7));
    for (std::uint32_t k = 0; k < 1U << 10U; ++k) {
      const sampling::Sobol sobol(7, k);
      const auto s = bsdf.sample(sobol.pair(0), sobol.one(1));
      ASSERT_TRUE(s.has_value());
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(s->weight[c], color[c], 1e-6);
    }
  }
}

TEST(Bsdf, WhiteDielectricConservesEnergy) {
  for (const float roughness : {0.1F, 0.4F, 0.7F, 1.0F}) {
    for (const double theta : {0.0, 0.6, 1.2, 1.5}) {
      const Scattering bsdf({.base_color = Vec3(1), .metallic = 0, .roughness = roughness},
                            direction(theta));
      EXPECT_NEAR(sampled_albedo(bsdf, 1U << 14U).x, 1, 0.003) << roughness << ' ' << theta;
    }
  }
}

TEST(Bsdf, NeverGainsEnergy) {
  for (const float roughness : {0.0F, 0.1F, 0.4F, 0.7F, 1.0F}) {
    for (const float metallic : {0.0F, 0.3F, 1.0F}) {
      for (const double theta : {0.0, 0.6, 1.2, 1.5}) {
        const Scattering bsdf({.base_color = Vec3(1), .metallic = metallic, .roughness = roughness},
                              direction(theta));
        EXPECT_LE(sampled_albedo(bsdf, 1U << 13U).x, 1.004)
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
    const Vec3 forth = Scattering(p, a).evaluate(b).value / b.z,
               back = Scattering(p, b).evaluate(a).value / a.z;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(forth[c], back[c], 2e-4F * (forth[c] + 0.01F));
  }
}

// Radiance divided by the square of the index of refraction is reciprocal across a boundary.
TEST(Bsdf, HalfGlassIsReciprocal) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0.05, 1);
  constexpr float kIor = 1.5F;
  for (int i = 0; i < 500; ++i) {
    Parameters p{.base_color = Vec3(u(random), u(random), u(random)),
                 .metallic = i % 2 == 0 ? 0 : float(u(random)),
                 .roughness = 0.3F + 0.7F * float(u(random)),
                 .transmission = float(u(random)),
                 .diffuse_transmission = i % 4 < 2 ? 0 : float(u(random))};
    const Vec3 a = direction(std::acos(u(random)), 6 * u(random));
    const Vec3 b = direction(std::acos(u(random)), 6 * u(random));
    const auto under = [](const Vec3& w) { return Vec3(w.x, w.y, -w.z); };
    const auto bsdf = [&](float eta, const Vec3& wo, const Vec3& wi) {
      p.eta = eta;
      return Scattering(p, wo).evaluate(wi).value / std::abs(wi.z);
    };
    const Vec3 in = bsdf(kIor, a, under(b)), out = kIor * kIor * bsdf(1 / kIor, b, under(a));
    const Vec3 forth = bsdf(1 / kIor, a, b), back = bsdf(1 / kIor, b, a);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(in[c], out[c], 1e-3F * (in[c] + 0.01F)) << i;
      EXPECT_NEAR(forth[c], back[c], 1e-3F * (forth[c] + 0.01F)) << i;
    }
  }
}

// Tests Snell's law: a smooth surface refracts to sin(theta) / eta.
TEST(Bsdf, SmoothGlassRefracts) {
  const Scattering bsdf({.roughness = 0, .transmission = 1, .eta = 1.5F}, direction(0.8, 0));
  int below = 0;
  for (std::uint32_t k = 0; k < 200; ++k) {
    const sampling::Sobol sobol(7, k);
    const auto s = bsdf.sample(sobol.pair(0), sobol.one(1));
    if (!s || s->wi.z > 0) continue;
    ++below;
    EXPECT_NEAR(s->wi.x, -std::sin(0.8) / 1.5, 0.01);
  }
  EXPECT_GT(below, 150);
}

// In a half-opaque body, light from inside must eventually leave without a gain of energy.
TEST(Bsdf, HalfGlassGainsNoEnergy) {
  for (const float roughness : {0.05F, 0.3F, 0.8F}) {
    for (const float eta : {1.5F, 1 / 1.5F, 1 / 2.0F}) {
      const float f0 = (1 - eta) * (1 - eta) / ((1 + eta) * (1 + eta));
      for (int step = 0; step < 16; ++step) {
        const double theta = 0.05 + 0.1 * step;
        const Parameters p{.base_color = Vec3(1),
                           .roughness = roughness,
                           .dielectric = {.f0 = Vec3(f0)},
                           .transmission = 0.5F,
                           .eta = eta};
        const double sum = sampled_albedo(Scattering(p, direction(theta)), 1U << 14U).x;
        EXPECT_LE(sum, 1.006) << roughness << ' ' << eta << ' ' << theta;
        EXPECT_GE(sum, 0.5) << roughness << ' ' << eta << ' ' << theta;
      }
    }
  }
}

// If white light passes through both walls of a body, the base color must multiply it only once.
TEST(Bsdf, GlassMultipliesTheBaseColorOnce) {
  const Parameters in{.base_color = {0.25F, 1, 1}, .roughness = 0, .transmission = 1, .eta = 1.5F};
  Parameters out = in;
  out.eta = 1 / 1.5F;
  float tint = 1;
  for (const Parameters& p : {in, out}) {
    const Scattering bsdf(p, {0, 0, 1});
    const Vec3 through = bsdf.evaluate({0, 0, -1}).value;
    tint *= through.x / through.y;
  }
  EXPECT_NEAR(tint, 0.25, 1e-4);
}

TEST(Bsdf, SpecularWeighsTheReflection) {
  const Vec3 wo = direction(0.3, 0), wi = direction(0.3, kPi);
  const auto value = [&](const Schlick<1>& schlick) {
    return Scattering({.base_color = Vec3(0), .roughness = 0.2F, .dielectric = schlick}, wo)
        .evaluate(wi)
        .value;
  };
  EXPECT_EQ(value({.f0 = Vec3(0), .f90 = 0}), Vec3(0));
  const Vec3 half = value({.f0 = Vec3(0.02F), .f90 = 0.5F}), whole = value({});
  EXPECT_NEAR(half.x / whole.x, 0.5, 0.005);
  const Vec3 red = value({.f0 = {0.04F, 0, 0}});
  EXPECT_FLOAT_EQ(red.x, whole.x);
  EXPECT_LT(red.y, 0.01F * red.x);
}

void check_pdf(const Scattering& bsdf, const std::string& what) {
  std::mt19937 random(3);
  EXPECT_LT(
      test_pdf(bsdf, {.rows = 24, .columns = 16, .fine = 48, .samples = 200'000}, random).excess, 5)
      << what;
}

TEST(Bsdf, SamplesHaveTheirPdf) {
  for (const float roughness : {0.3F, 0.6F, 1.0F}) {
    for (const double theta : {0.6, 1.2}) {
      const std::string place =
          " of roughness " + std::to_string(roughness) + " at " + std::to_string(theta);
      const auto check = [&](Parameters p, const std::string& what) {
        p.base_color = Vec3(0.6F);
        p.roughness = roughness;
        check_pdf(Scattering(p, direction(theta)), what + place);
      };
      check({}, "plastic");
      check({.metallic = 1}, "metal");
      check({.transmission = 0.7F}, "thin wall");
      check({.transmission = 1, .eta = 1.5F}, "glass from outside");
      check({.transmission = 0.8F, .eta = 1 / 1.5F}, "glass from within");
      check({.diffuse_transmission = 0.4F}, "paper");
    }
  }
}

}  // namespace
}  // namespace microtrace::bsdf
