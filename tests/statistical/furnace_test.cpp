// White furnace test: under uniform white light, non-absorbing objects must be as bright as the
// light, and no object may be brighter.

#include "support/shading/furnace.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace microtrace::bsdf {
namespace {

TEST(Furnace, Sheen) {
  for (const float roughness : {0.3F, 0.6F, 1.0F}) {
    const Layers layers{.sheen = Vec3(1), .sheen_roughness = roughness};
    expect_white("sheen on metal", kMetal, layers, 0.006);
    expect_white("sheen on a dielectric", kWhite, layers, 0.006);
  }
  for (const float roughness : {0.0F, 0.1F, 0.2F}) {
    const Layers layers{.sheen = Vec3(1), .sheen_roughness = roughness};
    expect_white("smooth sheen", kWhite, layers, 0.04);
  }
}

TEST(Furnace, ThinWall) {
  Parameters wall = kWhite;
  for (const float transmission : {0.5F, 1.0F}) {
    wall.transmission = transmission;
    expect_white("thin wall", wall, {}, 0.004);
    wall.film = ThinFilm<1>{};
    if (transmission == 1) expect_white("thin wall under a film", wall, {}, 0.004);
    wall.film.reset();
  }
  wall.diffuse_transmission = 0.5F;
  expect_white("paper", wall, {}, 0.004);
}

// The base below a film gets the light that the film does not reflect in the brightest channel.
TEST(Furnace, FilmsKeepTheLightOfTheBrightestChannel) {
  const auto brightest = [](const DVec3& v) { return std::max({v.x, v.y, v.z}); };
  for (const float metallic : {0.0F, 0.2F, 0.7F}) {
    for (const ThinFilm<1>& film :
         {ThinFilm<1>{}, ThinFilm<1>{.ior = 1.1F, .thickness = 700},
          ThinFilm<1>{.ior = 1.8F, .thickness = 900}, ThinFilm<1>{.ior = 2.3F, .thickness = 353}}) {
      for (const float roughness : {0.05F, 0.3F, 0.6F, 1.0F}) {
        Parameters p{.base_color = Vec3(1), .metallic = metallic, .roughness = roughness};
        for (const double theta : {0.05, 0.6, 1.05, 1.3, 1.45}) {
          const Vec3 wo = direction(theta, 0.3);
          p.film.reset();
          const double without = furnace(p, {}, wo, 1U << 14U).x;
          p.film = film;
          const double with = brightest(furnace(p, {}, wo, 1U << 14U));
          const std::string place = std::to_string(metallic) + " " + std::to_string(film.ior) +
                                    " " + std::to_string(roughness) + " " + std::to_string(theta);
          EXPECT_GT(with, without - 0.035) << place;
          EXPECT_LT(with, 1.025) << place;
        }
      }
    }
  }
}

TEST(Furnace, FilmsDoNotDependOnAnImperceptibleTransmission) {
  Parameters p{.base_color = Vec3(1), .metallic = 0.2F, .roughness = 0.05F, .film = ThinFilm<1>{}};
  const DVec3 opaque = furnace(p, {}, direction(0.05, 0.3), 1U << 14U);
  p.transmission = 1e-6F;
  const DVec3 transmitting = furnace(p, {}, direction(0.05, 0.3), 1U << 14U);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(opaque[c], transmitting[c], 0.003);
}

/// Expects that the surface of a body with this index of refraction loses little from both sides.
void expect_white_from_both_sides(const char* what, Parameters glass, float ior) {
  const float r = (ior - 1) / (ior + 1);
  glass.dielectric.f0 = Vec3(r * r);
  glass.eta = ior;
  expect_white(what, glass, {}, 0.01);
  glass.eta = 1 / ior;
  expect_white((std::string(what) + " from within").c_str(), glass, {}, 0.02);
}

TEST(Furnace, Glass) {
  Parameters glass = kWhite;
  glass.transmission = 1;
  for (const float ior : {1.1F, 1.33F, 1.5F, 1.8F, 2.4F})
    expect_white_from_both_sides("glass", glass, ior);
  glass.eta = 1.0F;
  glass.dielectric = {.f0 = Vec3(0), .f90 = 0};
  expect_white("a body of air", glass, {}, 0.02);
}

// What layers reflect of the light from inside stays inside. Losses remain on rough glass.
TEST(Furnace, GlassUnderLayers) {
  const Layers layers[] = {{.coat = 1},
                           {.coat = 0.7F, .coat_roughness = 0.3F},
                           {.sheen = Vec3(1), .sheen_roughness = 1},
                           {.sheen = Vec3(1), .sheen_roughness = 0.5F, .coat = 1}};
  for (Layers l : layers) {
    for (const float transmission : {0.0F, 0.5F, 1.0F}) {
      Parameters glass = kWhite;
      glass.transmission = transmission;
      l.side = LayerSide::above;
      glass.eta = 1.5F;
      expect_white("glass under layers", glass, l, 0.03, 0.3, 1.013);
      l.side = LayerSide::below;
      glass.eta = 1 / 1.5F;
      expect_white("glass under layers from within", glass, l, 0.08);
      glass.roughness = 0.05F;
      for (const double theta : {0.1, 0.5, 0.7, 0.9})
        EXPECT_NEAR(furnace(glass, l, direction(theta), 1U << 14U).x, 1, 0.004) << theta;
    }
  }
}

/// Expects little loss from both sides of a boundary with the index 1.5.
void expect_white_glass(const char* what, Parameters glass, double loss_outside, double loss_within,
                        double most = kMost) {
  glass.transmission = 1;
  glass.eta = 1.5F;
  expect_white(what, glass, {}, loss_outside, 0.3, most);
  glass.eta = 1 / 1.5F;
  expect_white((std::string(what) + " from within").c_str(), glass, {}, loss_within, 0.3, most);
}

// Glass whose reflectance is not that of its index of refraction, or depends on the azimuth.
TEST(Furnace, UnusualGlass) {
  Parameters glass = kWhite;
  glass.film = ThinFilm<1>{};
  expect_white_glass("glass under a film", glass, 0.035, 0.02, 1.01);
  glass.film = ThinFilm<1>{.share = 0.5F, .ior = 2.3F, .thickness = 500};
  expect_white_glass("glass half under a film", glass, 0.07, 0.03, 1.01);
  glass.film.reset();
  for (const float f0 : {0.0F, 0.1F, 0.3F, 1.0F}) {
    glass.dielectric.f0 = Vec3(f0);
    expect_white_glass("mirroring glass", glass, 0.016, 0.022);
  }
  for (const float f90 : {0.0F, 0.3F, 0.7F}) {
    glass.dielectric = {.f0 = Vec3(0.04F) * f90, .f90 = f90};
    expect_white_glass("glass with less reflection", glass, 0.01, 0.025);
  }
  glass.dielectric = {};
  glass.anisotropy = 0.5F;
  expect_white_glass("brushed glass", glass, 0.08, 0.22);
}

TEST(Furnace, MixturesOfMetalAndDielectric) {
  Parameters p = kWhite;
  for (const float metallic : {0.1F, 0.5F, 0.9F}) {
    p.metallic = metallic;
    p.transmission = 0;
    p.eta.reset();
    expect_white("mixture", p, {}, 0.004);
    expect_white("mixture under a coat", p, Layers{.coat = 1, .coat_roughness = 0.2F}, 0.006);
    p.transmission = 0.7F;
    expect_white("thin wall with metal", p, {}, 0.004);
    for (const float eta : {1.5F, 1 / 1.5F}) {
      p.eta = eta;
      expect_white("glass with metal", p, {}, 0.02);
    }
  }
}

// The part that is not transmitted is reflected diffusely, also from inside.
TEST(Furnace, HalfTransmittingGlass) {
  Parameters glass = kWhite;
  for (const float transmission : {0.1F, 0.5F, 0.9F}) {
    glass.transmission = transmission;
    for (const float ior : {1.33F, 1.8F}) {
      glass.diffuse_transmission = ior == 1.8F ? 0.5F : 0;
      expect_white_from_both_sides("half-transmitting glass", glass, ior);
    }
  }
}

TEST(Furnace, Anisotropic) {
  Parameters metal = kMetal, dielectric = kWhite, wall = kWhite;
  for (const float strength : {0.3F, 0.6F, 0.8F}) {
    for (const double azimuth : {0.0, 0.7, 1.5}) {
      metal.anisotropy = dielectric.anisotropy = wall.anisotropy = strength;
      wall.transmission = 1;
      expect_white("brushed metal", metal, {}, 0.02, azimuth);
      expect_white("brushed dielectric", dielectric, {}, 0.015, azimuth);
      expect_white("brushed wall", wall, {}, 0.02, azimuth);
    }
  }
}

/// Generates random materials. Some parameters are usually at the ends of their ranges.
class AnyMaterial {
 public:
  explicit AnyMaterial(unsigned seed) : random_(seed) {}

  float number() { return std::uniform_real_distribution<float>(0, 1)(random_); }
  bool chance(float p) { return number() < p; }
  float factor() { return chance(0.4F) ? static_cast<float>(chance(0.5F)) : number(); }
  Vec3 color() { return chance(0.5F) ? Vec3(1) : Vec3(factor(), factor(), factor()); }

  Parameters parameters() {
    Parameters p{
        .base_color = color(), .metallic = chance(0.4F) ? 0 : factor(), .roughness = factor()};
    const float ior = chance(0.2F) ? 1 : 1 + 1.5F * number(), r = (ior - 1) / (ior + 1);
    const float specular = chance(0.6F) ? 1 : factor();
    const Vec3 tint = chance(0.6F) ? Vec3(1) : 5.0F * Vec3(number(), number(), number());
    p.dielectric = {.f0 = glm::min(r * r * tint, Vec3(1)) * specular, .f90 = specular};
    if (chance(0.5F)) p.transmission = factor();
    if (p.transmission > 0 && chance(0.5F)) p.eta = chance(0.5F) ? ior : 1 / ior;
    if (chance(0.2F)) p.diffuse_transmission = factor();
    if (chance(0.3F)) p.anisotropy = factor();
    const double turn = 6.28 * number();
    p.along = Vec3(std::cos(turn), std::sin(turn), 0);
    if (chance(0.3F))
      p.film =
          ThinFilm<1>{.share = number(), .ior = 1 + 1.5F * number(), .thickness = 1000 * number()};
    return p;
  }

  /// Layers, and the coat's normal.
  struct Cover {
    std::optional<Layers> layers{};
    Vec3 coat_normal{0, 0, 1};
  };
  Cover cover(const Parameters& base) {
    if (chance(0.5F)) return {};
    Cover result;
    Layers& l = result.layers.emplace();
    if (chance(0.6F)) l.coat = factor();
    if (chance(0.6F)) l.sheen = color();
    l.coat_roughness = factor();
    l.sheen_roughness = factor();
    if (chance(0.3F)) result.coat_normal = direction(0.5 * number(), 6.28 * number());
    if (base.eta) l.side = *base.eta > 1 ? LayerSide::above : LayerSide::below;
    return result;
  }

  Vec3 above() { return direction(std::min(std::acos(number()), 1.56F), 6.28 * number()); }

 private:
  std::mt19937 random_;
};

TEST(Furnace, NothingGainsEnergy) {
  AnyMaterial any(1);
  for (int i = 0; i < 1500; ++i) {
    const Parameters p = any.parameters();
    auto [layers, coat_normal] = any.cover(p);
    const Vec3 wo = any.above();
    if (!(glm::dot(coat_normal, wo) > 0.01F)) coat_normal = {0, 0, 1};
    DVec3 sum = furnace(p, layers, wo, 1U << 11U, coat_normal);
    if (std::max({sum.x, sum.y, sum.z}) > kMost)
      sum = furnace(p, layers, wo, 1U << 17U, coat_normal);
    // The energy bounds of anisotropic facets, thin films and turned coats are not strict.
    const double bound = p.film              ? 1.025
                         : coat_normal.z < 1 ? kMostUnderTurnedCoat
                         : p.anisotropy > 0  ? 1.01
                                             : kMost;
    for (int c = 0; c < 3; ++c)
      EXPECT_LT(sum[c], bound) << i << ": " << p.roughness << ' ' << p.metallic << ' '
                               << p.transmission << ' ' << p.eta.value_or(0) << ' ' << p.anisotropy
                               << ' ' << (p.film ? p.film->share : 0) << ' ' << wo.z;
  }
}

// Checks that the pdfs of random materials integrate to at most one, and match the samples.
TEST(Furnace, PdfsAreThoseOfTheSamples) {
  AnyMaterial any(2);
  std::mt19937 random(3);
  for (int i = 0; i < 40; ++i) {
    Parameters p = any.parameters();
    p.roughness = 0.35F + 0.65F * p.roughness;
    // If a surface hardly refracts, its lobes are narrower than the histogram's cells.
    if (p.eta) p.eta = *p.eta > 1 ? std::max(*p.eta, 1.2F) : std::min(*p.eta, 0.8F);
    auto [layers, coat_normal] = any.cover(p);
    if (layers) layers->coat_roughness = 0.35F + 0.65F * layers->coat_roughness;
    const Vec3 wo = direction(0.9F * any.number());
    const PdfTest test =
        test_pdf(Scattering(p, layers, wo, coat_normal),
                 {.rows = 16, .columns = 12, .fine = 32, .samples = 50'000}, random);
    EXPECT_LT(test.mass, 1.003) << i;
    EXPECT_LT(test.excess, 5) << i;
  }
}

}  // namespace
}  // namespace microtrace::bsdf
