// Compares tables of albedos with integrals that use a different method: they integrate over light
// directions instead of visible normals.

#include "render/bsdf/anisotropic_albedo.hpp"
#include "render/bsdf/coating.hpp"
#include "render/bsdf/refraction_loss.hpp"
#include "render/bsdf/sheen.hpp"
#include "support/pi.hpp"
#include "support/shading/direction_pdf.hpp"
#include "support/shading/scattering.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace microtrace::bsdf {
namespace {

/// Integrates f over the hemisphere by the midpoint rule in cos(theta)^(1/2) and the azimuth.
template <class F>
double integral(int steps, const F& f) {
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double root = (i + 0.5) / steps;
      sum += f(direction(std::acos(root * root), 2 * kPi * (j + 0.5) / steps)) * 2 * root;
    }
  }
  return sum * 2 * kPi / (steps * steps);
}

TEST(AlbedoTables, AnisotropicReflectors) {
  double rms = 0, edge_rms = 0;
  int count = 0;
  for (const float roughness : {0.35F, 0.6F, 0.9F}) {
    for (const float strength : {0.2F, 0.5F, 0.8F}) {
      const AnisotropicGgx<1> ggx(roughness, strength, {1, 0});
      const AnisotropicGgxAlbedo<1> albedo(ggx);
      for (const double theta : {0.1, 0.7, 1.1, 1.4}) {
        for (const double azimuth : {0.0, 0.8, 1.5}) {
          const Vec3 wo = direction(theta, azimuth);
          const auto returned = [&](auto fresnel) {
            return integral(250, [&](const Vec3& wi) {
              const Vec3 h = unit<1>(wo + wi);
              const double f = ggx.distribution(h) * ggx.visibility(wo, wi) * wi.z;
              return f * fresnel(1 - glm::dot(wo, h));
            });
          };
          const double white = returned([](double) { return 1; });
          const double edge = returned([](double x) { return x * x * x * x * x; });
          const Albedo<1> got = albedo.at(wo);
          EXPECT_NEAR(got.f1, white, 0.012) << roughness << ' ' << strength << ' ' << theta;
          EXPECT_NEAR(got.schlick, edge, 0.03) << roughness << ' ' << strength << ' ' << theta;
          rms += (got.f1 - white) * (got.f1 - white);
          edge_rms += (got.schlick - edge) * (got.schlick - edge);
          ++count;
        }
      }
    }
  }
  EXPECT_LT(std::sqrt(rms / count), 0.002);
  EXPECT_LT(std::sqrt(edge_rms / count), 0.006);
}

TEST(AlbedoTables, MeansOfAnisotropicReflectors) {
  for (const float roughness : {0.1F, 0.4F, 0.8F}) {
    for (const float strength : {0.3F, 0.7F, 1.0F}) {
      const AnisotropicGgxAlbedo<1> albedo(AnisotropicGgx<1>(roughness, strength, {0.6F, 0.8F}));
      const auto mean = [&](auto part) {
        return integral(200, [&](const Vec3& w) { return part(albedo.at(w)) * w.z; }) / kPi;
      };
      EXPECT_NEAR(albedo.mean().f1, mean([](const Albedo<1>& a) { return a.f1; }), 0.002);
      EXPECT_NEAR(albedo.mean().schlick, mean([](const Albedo<1>& a) { return a.schlick; }), 0.002);
    }
  }
}

TEST(AlbedoTables, EnergyDeficitUnderACoat) {
  for (const float roughness : {0.3F, 0.55F, 0.8F, 1.0F}) {
    for (const float coat_roughness : {0.0F, 0.4F}) {
      const Coating<1> coating(
          surface_of({.roughness = roughness}, {.coat = 1, .coat_roughness = coat_roughness}));
      const Ggx<1> ggx(roughness);
      for (const double theta : {0.1, 0.6, 1.0, 1.3, 1.5}) {
        const Vec3 wo = direction(theta);
        double white = 0, edge = 0;
        integral(300, [&](const Vec3& wi) {
          const Vec3 h = unit<1>(wo + wi);
          const double less = std::max(coating.transmittance(wo) - coating.transmittance(wi), 0.0F);
          const double root = std::sqrt(wi.z), x = 1 - glm::dot(wo, h);
          const double f = ggx.distribution(h) * ggx.visibility(wo, wi) * wi.z * less * 2 * root *
                           2 * kPi / (300 * 300);
          white += f;
          edge += f * x * x * x * x * x;
          return 0;
        });
        EXPECT_NEAR(coating.deficit(wo.z).f1, white, 0.0015) << roughness << ' ' << theta;
        EXPECT_NEAR(coating.deficit(wo.z).schlick, edge, 0.0015) << roughness << ' ' << theta;
      }
    }
  }
}

TEST(AlbedoTables, NodesOfTheCoatingIntegrate) {
  for (int power = 0; power < 12; ++power) {
    double sum = 0;
    for (std::size_t k = 0; k < kCoatingNodes; ++k)
      sum += kCoatingWeight[k] * std::pow(double(kCoatingNode[k]), power);
    EXPECT_NEAR(sum, 2.0 / (power + 2), 1e-5) << power;
  }
}

RefractionLoss<1> loss_of(float roughness, float eta, float f0) {
  return RefractionLoss<1>(
      {.roughness = roughness, .eta = eta, .dielectric = {.f0 = f0, .f90 = 1}},
      [&](float) { return RefractionLoss<1>::F0Range{.least = f0, .most = f0}; });
}

// If everything that is not reflected is transmitted, the energy deficit is the energy that single
// scattering does not return.
TEST(AlbedoTables, EnergyDeficitOfRoughGlass) {
  double rms = 0, most = 0;
  int count = 0;
  for (const float ior : {1.2F, 1.5F, 2.0F}) {
    const float r = (ior - 1) / (ior + 1);
    for (const float roughness : {0.3F, 0.5F, 0.75F, 1.0F}) {
      for (const float eta : {ior, 1 / ior}) {
        const RefractionLoss<1> loss = loss_of(roughness, eta, r * r);
        const Ggx<1> ggx(roughness);
        for (const double theta : {0.1, 0.6, 1.0, 1.3}) {
          const Vec3 wo = direction(theta);
          // Integrates over the normals that are visible from wo.
          double sum = 0;
          constexpr int steps = 150;
          for (int i = 0; i < steps * steps; ++i) {
            const Vec2 u((i % steps + 0.5) / steps, (i / steps + 0.5) / steps);
            const Vec3 h = ggx.visible_normal(wo, u);
            const float cosine = std::min(glm::dot(wo, h), 1.0F);
            const Vec3 up = 2 * cosine * h - wo;
            const float square = 1 - (1 - cosine * cosine) / (eta * eta);
            const float thin = eta < 1 ? std::sqrt(std::max(square, 0.0F)) : cosine;
            const float f = square > 0 ? Schlick<1>{.f0 = Vec3(r * r)}(thin).x : 1;
            const auto g1 = [&](float z) { return 2 * z / (z + ggx.root(z)); };
            if (up.z > 0) {
              const float both = up.z * (wo.z + ggx.root(wo.z));
              sum += f * both / (wo.z * ggx.root(up.z) + up.z * ggx.root(wo.z));
            }
            if (!(square > 0)) continue;
            const Vec3 down = (cosine / eta - std::sqrt(square)) * h - wo / eta;
            if (down.z < 0) sum += (1 - f) * std::min(1.0F, g1(-down.z) / g1(wo.z));
          }
          const double lost = 1 - sum / (steps * steps), got = loss.above(wo.z);
          EXPECT_LT(got, lost + 0.0015) << ior << ' ' << eta << ' ' << roughness << ' ' << theta;
          most = std::max(most, lost - got);
          rms += (got - lost) * (got - lost);
          ++count;
          EXPECT_EQ(loss.above(wo.z), loss_of(roughness, 1 / eta, r * r).below(wo.z));
        }
      }
    }
  }
  EXPECT_LT(most, 0.02);
  EXPECT_LT(std::sqrt(rms / count), 0.006);
}

TEST(AlbedoTables, MeanDeficitOfRoughGlass) {
  const RefractionLoss<1> loss = loss_of(0.7F, 1.5F, 0.04F);
  const double above = integral(200, [&](const Vec3& w) { return loss.above(w.z) * w.z; }) / kPi;
  const double below = integral(200, [&](const Vec3& w) { return loss.below(w.z) * w.z; }) / kPi;
  EXPECT_NEAR(loss.mean_above(), above, 1e-3 * above);
  EXPECT_NEAR(loss.mean_below(), below, 1e-3 * below);
}

TEST(AlbedoTables, SheenReturnsItsAlbedo) {
  for (const float roughness : {0.05F, 0.1F, 0.2F, 0.3F, 0.5F, 0.85F, 1.0F}) {
    const SheenLobe<1> sheen(roughness);
    for (const double theta : {0.0, 0.7, 1.2, 1.45, 1.53}) {
      const Vec3 wo = direction(theta);
      const double wanted = integral(400, [&](const Vec3& wi) {
        return double(sheen.reflectance(wo, wi, unit<1>(wo + wi))) * wi.z;
      });
      EXPECT_NEAR(sheen.albedo(wo.z), wanted, 0.012) << roughness << ' ' << theta;
      EXPECT_LE(wanted, 1.003) << roughness << ' ' << theta;
    }
  }
}

}  // namespace
}  // namespace microtrace::bsdf
