#include "support/pi.hpp"
#include "support/shading/direction_pdf.hpp"
#include "support/shading/furnace.hpp"
#include "support/shading/scattering.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace::bsdf {
namespace {

struct Example {
  const char* name;
  Parameters base;
  std::optional<Layers> layers{};
  Vec3 coat_normal{0, 0, 1};
};

/// Returns at least one material of each kind. None absorbs light, except for colored reflection at
/// normal incidence.
std::vector<Example> surfaces() {
  std::vector<Example> result;
  for (const float roughness : {0.3F, 0.8F}) {
    const Parameters dielectric{.base_color = Vec3(1), .metallic = 0, .roughness = roughness};
    Parameters metal = dielectric, glass = dielectric, wall = dielectric, film = dielectric;
    metal.metallic = 1;
    wall.transmission = 0.6F;
    glass.transmission = 1;
    glass.eta = 1.5F;
    film.film = ThinFilm<1>{.share = 0.7F, .ior = 1.8F, .thickness = 500};
    Parameters brushed = metal, filmed = metal, all = dielectric, out = glass;
    brushed.anisotropy = 0.8F;
    brushed.along = {0.6F, 0.8F, 0};
    filmed.film = ThinFilm<1>{.thickness = 300};
    out.eta = 1 / 1.5F;
    all.transmission = 0.3F;
    all.diffuse_transmission = 0.5F;
    all.anisotropy = 0.5F;
    all.film = ThinFilm<1>{.share = 0.5F};
    const Layers coat{.coat = 1, .coat_roughness = 0.2F};
    const Layers cloth{.sheen = {1, 0.5F, 0.2F}, .sheen_roughness = 0.4F};
    const Layers both{
        .sheen = {0.5F, 0.4F, 0.2F}, .sheen_roughness = 0.5F, .coat = 0.7F, .coat_roughness = 0.3F};
    Layers above = both, below = both;
    above.side = LayerSide::above;
    below.side = LayerSide::below;
    result.push_back({"brushed metal", brushed});
    result.push_back({"film on metal", filmed});
    result.push_back({"film", film});
    result.push_back({"cloth", dielectric, cloth});
    result.push_back({"coat", dielectric, coat});
    result.push_back({"coat on metal", metal, coat});
    result.push_back({"layers on a wall", wall, both});
    result.push_back({"layers on glass", glass, above});
    result.push_back({"glass under layers", out, below});
    Parameters half = glass, half_out = out;
    half.transmission = half_out.transmission = 0.4F;
    half.diffuse_transmission = half_out.diffuse_transmission = 0.5F;
    result.push_back({"layers on half-transmitting glass", half, above});
    result.push_back({"half-transmitting glass under layers", half_out, below});
    Parameters mixed = wall;
    mixed.metallic = 0.4F;
    Layers smooth_cloth = cloth;
    smooth_cloth.sheen_roughness = 0.08F;
    result.push_back({"all at once", all, both});
    result.push_back({"thin wall", wall});
    result.push_back({"half metal, half wall", mixed});
    result.push_back({"glass", glass});
    result.push_back({"glass from within", out});
    result.push_back({"turned coat", metal, both, direction(0.3, 1)});
    result.push_back({"smooth cloth", dielectric, smooth_cloth});
  }
  return result;
}

/// Returns the material as seen from the other side of the surface: rotated by 180 degrees about x.
Example turned(Example s) {
  if (s.base.eta) s.base.eta = 1 / *s.base.eta;
  s.base.along.y = -s.base.along.y;
  if (!s.layers || s.layers->side == LayerSide::both) return s;
  s.layers->side = s.layers->side == LayerSide::above ? LayerSide::below : LayerSide::above;
  return s;
}

Vec3 turned(const Vec3& v) {
  return {v.x, -v.y, -v.z};
}

Scattering scattering(const Example& s, const Vec3& wo) {
  return {s.base, s.layers, wo, s.coat_normal};
}

std::string text(const Example& s, double theta) {
  return std::string(s.name) + " " + std::to_string(s.base.roughness) + " " + std::to_string(theta);
}

TEST(Layered, NeverGainsEnergy) {
  for (const Example& s : surfaces()) {
    for (const double theta : {0.0, 0.5, 1.0, 1.3, 1.5}) {
      const DVec3 sum = sampled_albedo(scattering(s, direction(theta)), 1U << 16U);
      for (int c = 0; c < 3; ++c) EXPECT_LE(sum[c], 1.003) << text(s, theta);
    }
  }
}

TEST(Layered, PlainSurfacesAreASpecialCase) {
  for (const float roughness : {0.1F, 0.4F, 0.9F}) {
    for (const float metallic : {0.0F, 0.3F, 1.0F}) {
      const Parameters p{
          .base_color = {0.9F, 0.5F, 0.2F}, .metallic = metallic, .roughness = roughness};
      ASSERT_EQ(features_of(p, {}).index(), 0);
      const Vec3 wo = direction(0.7), wi = direction(0.4, 2);
      const Evaluation<1> general =
          Bsdf<1, IsotropicParts<1>>({}, surface_of(p), nullptr, wo).evaluate(wi);
      const Evaluation<1> plain = Scattering(p, wo).evaluate(wi);
      EXPECT_EQ(general.value, plain.value);
      EXPECT_EQ(general.pdf, plain.pdf);
    }
  }
}

TEST(Anisotropic, WithoutStrengthIsTheBase) {
  for (const float metallic : {0.0F, 1.0F}) {
    const Parameters p{.base_color = {0.9F, 0.5F, 0.2F}, .metallic = metallic, .roughness = 0.3F};
    const Vec3 wo = direction(0.7), wi = direction(0.5, 2.9);
    const Vec3 plain = Scattering(p, wo).evaluate(wi).value;
    const Vec3 general = Scattering({.is_anisotropic = true}, surface_of(p), wo).evaluate(wi).value;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(general[c] / plain[c], 1, 0.005);
  }
}

TEST(Anisotropic, HighlightsAreElongated) {
  const Parameters p{.base_color = Vec3(1), .metallic = 1, .roughness = 0.3F, .anisotropy = 0.7F};
  const Scattering bsdf(p, {}, {0, 0, 1});
  EXPECT_GT(bsdf.evaluate(direction(0.5, 0)).value.x,
            4 * bsdf.evaluate(direction(0.5, kPi / 2)).value.x);
}

TEST(Layered, SamplerAndQuadratureAgree) {
  for (const Example& s : surfaces()) {
    for (const double theta : {0.2, 1.0}) {
      const Scattering bsdf = scattering(s, direction(theta));
      const DVec3 a = sampled_albedo(bsdf, 1U << 14U), b = integrated_albedo(bsdf, 200);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 0.006) << text(s, theta);
    }
  }
}

/// Returns the material with a black base below its coat.
Example coat_of(Example s) {
  s.base = {.base_color = Vec3(0), .dielectric = {.f0 = Vec3(0), .f90 = 0}};
  s.layers->sheen = Vec3(0);
  return s;
}

void expect_equal(const Vec3& forth, const Vec3& back, float tolerance, const std::string& what) {
  for (int c = 0; c < 3; ++c)
    ASSERT_NEAR(forth[c], back[c], tolerance * (forth[c] + 0.01F)) << what;
}

TEST(Layered, IsReciprocal) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0.02, 1);
  for (const Example& s : surfaces()) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 a = direction(std::acos(u(random)), 6 * u(random));
      Vec3 b = direction(std::acos(u(random)), 6 * u(random));
      Vec3 to_b = scattering(s, a).evaluate(b).value, to_a = scattering(s, b).evaluate(a).value;
      // A coat is reciprocal about its own normal.
      if (s.coat_normal.z < 1) {
        const Example coat = coat_of(s);
        const Vec3 coat_to_b = scattering(coat, a).evaluate(b).value,
                   coat_to_a = scattering(coat, b).evaluate(a).value;
        const float cos_a = glm::dot(a, s.coat_normal), cos_b = glm::dot(b, s.coat_normal);
        if (cos_a > 0 && cos_b > 0)
          expect_equal(coat_to_b / cos_b, coat_to_a / cos_a, 1e-3F, "coat");
        to_b -= coat_to_b;
        to_a -= coat_to_a;
      }
      expect_equal(to_b / b.z, to_a / a.z, 1e-3F, std::string(s.name) + " above");
      const float square = s.base.eta ? *s.base.eta * *s.base.eta : 1;
      b.z = -b.z;
      const Vec3 home = scattering(turned(s), turned(b)).evaluate(turned(a)).value / a.z * square;
      // Where a turned coat reflects below the horizon of the shading normal, nothing is
      // transmitted.
      if (s.coat_normal.z == 1 || s.base.transmission > 0)
        expect_equal(scattering(s, a).evaluate(b).value / -b.z, home, 2e-3F,
                     std::string(s.name) + " through");
    }
  }
}

TEST(Layered, SamplesHaveTheirPdf) {
  std::mt19937 random(3);
  for (const Example& s : surfaces()) {
    const PdfTest test =
        test_pdf(scattering(s, direction(0.6)),
                 {.rows = 20, .columns = 14, .fine = 16, .samples = 100'000}, random);
    EXPECT_LT(test.mass, 1.003) << s.name;
    EXPECT_LT(test.excess, 5) << text(s, 0.6);
  }
}

TEST(ThinFilm, ZeroThicknessHasNoEffect) {
  const Vec3 f0(0.04F, 0.3F, 0.9F), film = thin_film_reflectance<1>(1, {.thickness = 0}, f0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(film[c], f0[c], 0.02F);
}

TEST(ThinFilm, ColorsVaryWithThickness) {
  const Vec3 thin = thin_film_reflectance<1>(1, {.ior = 1.33F, .thickness = 300}, Vec3(0.1F));
  const Vec3 thick = thin_film_reflectance<1>(1, {.ior = 1.33F, .thickness = 400}, Vec3(0.1F));
  EXPECT_GT(glm::distance(thin, thick), 0.02F);
  EXPECT_GT(std::abs(thin.x - thin.z) + std::abs(thin.x - thin.y), 0.01F) << "has a color";
}

}  // namespace
}  // namespace microtrace::bsdf
