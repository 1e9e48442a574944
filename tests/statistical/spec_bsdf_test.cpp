// Compares BsdfModel::spec with an independent implementation of the specification's formulas.

#include "support/pi.hpp"
#include "support/pictures.hpp"
#include "support/shading/direction_pdf.hpp"
#include "support/shading/furnace.hpp"
#include "support/shading/scattering.hpp"
#include "support/shading/spec_reference.hpp"

#include <microtrace/environment.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace::bsdf {
namespace {

struct SpecExample {
  const char* name;
  Parameters base;
  Layers layers{};
  Vec3 coat_normal{0, 0, 1};

  [[nodiscard]] Scattering scattering(const Vec3& wo) const {
    Features features = features_of(base, layers);
    features.is_spec = true;
    return {features, surface_of(base, layers, coat_normal), wo};
  }
  [[nodiscard]] SpecReference reference() const { return {base, layers, DVec3(coat_normal)}; }
};

/// Returns one surface of each kind.
std::vector<SpecExample> surfaces(float roughness) {
  const Parameters dielectric{.base_color = {0.9F, 0.6F, 0.2F}, .roughness = roughness};
  const auto changed = [&](auto change) {
    Parameters p = dielectric;
    change(p);
    return p;
  };
  const Parameters metal = changed([](auto& p) { p.metallic = 1; });
  const Parameters wall = changed([](auto& p) { p.transmission = 0.6F; });
  const Parameters glass = changed([](auto& p) { p.transmission = 0.7F, p.eta = 1.5F; });
  const Parameters inside = changed([](auto& p) { p.transmission = 1, p.eta = 1 / 1.5F; });
  const Layers coat{.coat = 0.8F, .coat_roughness = 0.3F};
  const Layers cloth{.sheen = {0.7F, 0.5F, 0.2F}, .sheen_roughness = 0.4F};
  const Layers both{
      .sheen = {0.5F, 0.4F, 0.2F}, .sheen_roughness = 0.5F, .coat = 0.7F, .coat_roughness = 0.3F};
  Layers above = both;
  above.side = LayerSide::above;
  return {
      {"dielectric", dielectric},
      {"metal", metal},
      {"half metal", changed([](auto& p) { p.metallic = 0.4F; })},
      {"colored specular", changed([](auto& p) {
         p.dielectric = {.f0 = {0.3F, 0.1F, 0.05F}, .f90 = 0.8F};
       })},
      {"brushed", changed([](auto& p) {
         p.anisotropy = 0.7F, p.along = {0.6F, 0.8F, 0};
       })},
      {"film", changed([](auto& p) {
         p.film = ThinFilm<1>{.share = 0.7F, .ior = 1.8F, .thickness = 500}, p.metallic = 0.3F;
       })},
      {"paper", changed([](auto& p) {
         p.diffuse_transmission = 0.4F, p.diffuse_transmission_color = {0.2F, 0.9F, 0.5F};
       })},
      {"thin wall", wall},
      {"glass", glass},
      {"glass from inside", inside},
      {"coat", dielectric, coat},
      {"coat on metal", metal, coat},
      {"turned coat", metal, coat, direction(0.3, 1)},
      {"cloth", dielectric, cloth},
      {"coat on cloth", dielectric, both},
      {"layers on a wall", wall, both},
      {"layers on glass", glass, above},
  };
}

TEST(SpecBsdf, ValuesAreThoseOfTheSpecification) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (const float roughness : {0.25F, 0.6F, 1.0F}) {
    for (const SpecExample& surface : surfaces(roughness)) {
      for (int i = 0; i < 200; ++i) {
        const Vec3 wo = direction(std::acos(0.05 + 0.95 * u(random)), 7 * u(random));
        const Vec3 wi = direction(std::acos(2 * u(random) - 1), 7 * u(random));
        const DVec3 got = surface.scattering(wo).evaluate(wi).value;
        const DVec3 wanted = surface.reference().value(DVec3(wo), DVec3(wi));
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(got[c], wanted[c], 1e-3 * wanted[c] + 1e-6)
              << surface.name << ' ' << roughness;
      }
    }
  }
}

TEST(SpecBsdf, SamplesHaveTheirPdf) {
  std::mt19937 random(2);
  for (const SpecExample& surface : surfaces(0.4F)) {
    for (const double theta : {0.3, 1.1}) {
      const PdfTest result =
          test_pdf(surface.scattering(direction(theta, 0.7)),
                   {.rows = 20, .columns = 14, .fine = 24, .samples = 60'000}, random);
      EXPECT_LT(result.mass, 1.003) << surface.name << ' ' << theta;
      EXPECT_LT(result.excess, 5) << surface.name << ' ' << theta;
    }
  }
}

/// Estimates the directional albedo for wo by sampling.
double albedo(const SpecExample& surface, const Vec3& wo) {
  return sampled_albedo(surface.scattering(wo), 1U << 15U).x;
}

/// Integrates the reference over all directions by the midpoint rule.
double integrated(const SpecReference& reference, const DVec3& v) {
  constexpr int steps = 400;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double theta = (i + 0.5) / steps * kPi, phi = (j + 0.5) / steps * 2 * kPi;
      sum += reference.value(v, DVec3(direction(theta, phi))).x * std::sin(theta);
    }
  }
  return sum * (kPi / steps) * (2 * kPi / steps);
}

TEST(SpecBsdf, SamplerAndQuadratureAgree) {
  for (const SpecExample& surface : surfaces(0.6F)) {
    for (const double theta : {0.2, 0.9}) {
      const Vec3 wo = direction(theta, 0.7);
      EXPECT_NEAR(albedo(surface, wo), integrated(surface.reference(), DVec3(wo)), 0.005)
          << surface.name << ' ' << theta;
    }
  }
}

// The albedo of single scattering by GGX with alpha = 1 at normal incidence is the integral of 2
// cos(2 t) / (1 + cos(2 t)) over the normals' sin(2 t), up to t = 45 degrees: 1 - log(2).
TEST(SpecBsdf, RoughMetalLosesEnergy) {
  const SpecExample metal{"metal", {.base_color = Vec3(1), .metallic = 1, .roughness = 1}};
  EXPECT_NEAR(albedo(metal, direction(0)), 1 - std::numbers::ln2, 0.002);
}

// The same on a sphere under uniform light, through the whole integrator.
TEST(SpecBsdf, PathsUseTheModel) {
  Scene scene;
  scene.materials = {{.metallic = 1, .roughness = 1}};
  scene.objects = {{.name = "", .shape = Sphere{{0, 0, 0}, 1}, .material = 0}};
  scene.environment = Environment{.content = Vec3(1)};
  const PerspectiveCamera camera{.pose = {.position = {0, 0, 100}, .direction = {0, 0, -1}},
                                 .vertical_fov = 0.001};
  const auto mean = [&](BsdfModel model) {
    const PathIntegrator path({.bsdf = model});
    return mean_of(render(scene, camera, {2, 2}, {.integrator = &path, .samples = 4096})).x;
  };
  EXPECT_NEAR(mean(BsdfModel::spec), 1 - std::numbers::ln2, 0.01);
  EXPECT_NEAR(mean(BsdfModel::conserving), 1, 0.01);
}

}  // namespace
}  // namespace microtrace::bsdf
