#include "render/lights/environment/environment_light.hpp"

#include "render/lanes/dispatch.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/lights/environment/studio.hpp"
#include "render/prepared/shared_tables.hpp"
#include "render/sampling/sobol.hpp"
#include "support/pi.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

struct DirectionSample {
  Vec3 wi, radiance;
  float pdf;
};

DirectionSample sample_in(const MapLanes<kShadingLanes>& lanes, int lane) {
  return {.wi = got(lanes.d, lane), .radiance = got(lanes.radiance, lane), .pdf = lanes.pdf[lane]};
}

DirectionSample sample_of(const EnvironmentLight& light, const Vec2& u) {
  const LaneFloats numbers[2] = {{u.x}, {u.y}};
  MapLanes<kShadingLanes> lanes{};
  light.sample(1, numbers, lanes);
  return sample_in(lanes, 0);
}

/// Sets u to numbers of this round.
void put_numbers(LaneFloats (&u)[2], std::uint32_t seed, std::uint32_t round) {
  for (int i = 0; i < kShadingLanes; ++i) {
    const Vec2 pair = sampling::Sobol(seed, 16 * round + static_cast<std::uint32_t>(i)).pair(0);
    u[0][i] = pair.x;
    u[1][i] = pair.y;
  }
}

std::shared_ptr<const RadianceMap> map_of(
    std::uint32_t width, std::uint32_t height,
    const std::function<Vec3(std::uint32_t, std::uint32_t)>& f) {
  RadianceMap map{.width = width, .height = height};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) map.pixels.push_back(f(x, y));
  }
  return std::make_shared<const RadianceMap>(std::move(map));
}

/// Returns a dim map with a sun that is one pixel wide.
std::shared_ptr<const RadianceMap> sunny_map(std::uint32_t width, std::uint32_t height) {
  return map_of(width, height, [&](std::uint32_t x, std::uint32_t y) {
    if (x == width / 3 && y == height / 4) return Vec3(20000, 18000, 15000);
    return Vec3(0.1F + 0.3F * static_cast<float>(x % 5), 0.2F, 0.05F * static_cast<float>(y % 7));
  });
}

/// Calls f with the midpoints and the solid angles of the cells of a fine grid. The solid angles
/// sum to 4 pi.
template <class F>
void for_sphere(std::uint32_t rows, F&& f) {
  for (std::uint32_t j = 0; j < rows; ++j) {
    const double y = 1 - (2 * j + 1.0) / rows;
    const double r = std::sqrt(1 - y * y);
    for (std::uint32_t i = 0; i < 2 * rows; ++i) {
      const double phi = (i + 0.5) / rows * kPi;
      f(Vec3(DVec3(r * std::cos(phi), y, r * std::sin(phi))), 2 * kPi / rows / rows);
    }
  }
}

Vec2 sobol(std::uint32_t i) {
  return sampling::Sobol(7, i).pair(0);
}

TEST(EnvironmentLight, UniformLightIsEqualInAllDirections) {
  const EnvironmentLight light({.content = Vec3(1, 2, 3), .rotation = 1, .intensity = 0.5F});
  EXPECT_TRUE(light.is_uniform());
  DVec3 sum(0);
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const DirectionSample sample = sample_of(light, sobol(i));
    EXPECT_EQ(sample.radiance, Vec3(0.5F, 1, 1.5F));
    EXPECT_EQ(light.radiance(sample.wi), sample.radiance);
    EXPECT_NEAR(sample.pdf, 1 / (4 * kPi), 1e-8);
    EXPECT_NEAR(glm::length(sample.wi), 1, 1e-6);
    sum += DVec3(sample.wi) / 4096.0;
  }
  EXPECT_NEAR(glm::length(sum), 0, 1e-3);
}

// Checks the mapping documented in the header for directions through pixel centers.
TEST(EnvironmentLight, UsesTheDocumentedMapping) {
  const std::uint32_t width = 64, height = 32;
  const auto map = map_of(width, height, [](std::uint32_t x, std::uint32_t y) {
    return Vec3(static_cast<float>(x), static_cast<float>(y), 1);
  });
  const EnvironmentLight light({.content = map});
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double phi = ((x + 0.5) / width - 0.5) * 2 * kPi, theta = (y + 0.5) / height * kPi;
      const Vec3 direction(
          DVec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
      const Vec3 radiance = light.radiance(direction);
      ASSERT_NEAR(radiance.x, x, 1e-3);
      ASSERT_NEAR(radiance.y, y, 1e-3);
      ASSERT_NEAR(radiance.z, 1, 1e-6);
    }
  }
}

TEST(EnvironmentLight, IsBilinearAcrossTheSeam) {
  const auto map = map_of(4, 2, [](std::uint32_t x, std::uint32_t) {
    return Vec3(x == 0 ? 1.0F : x == 3 ? 3.0F : 0.0F);
  });
  const EnvironmentLight light({.content = map});
  EXPECT_NEAR(light.radiance({-1, 0, 0}).x, 2, 1e-5);
  EXPECT_NEAR(light.radiance({-1, 0, -1e-6F}).x, 2, 1e-5);
  EXPECT_NEAR(light.radiance({0, 1, 0}).x, 0, 1e-5);  // atan2(0, 0) = 0, the middle of the map
  EXPECT_NEAR(light.radiance({-1, 0, -1}).x, 1, 1e-5);
}

TEST(EnvironmentLight, RotatesCounterclockwiseSeenFromAbove) {
  const auto map = sunny_map(32, 16);
  const double angle = 1.25;
  const EnvironmentLight still({.content = map}), turned({.content = map, .rotation = angle});
  for_sphere(20, [&](const Vec3& d, double) {
    const double c = std::cos(angle), s = std::sin(angle);
    const Vec3 image(
        DVec3(c * double{d.x} + s * double{d.z}, d.y, c * double{d.z} - s * double{d.x}));
    const Vec3 a = still.radiance(d), b = turned.radiance(image);
    ASSERT_NEAR(a.x, b.x, 1e-2 + 1e-3 * double{a.x});
    ASSERT_NEAR(still.lookup(d).pdf, turned.lookup(image).pdf,
                1e-3 * double{still.lookup(d).pdf} + 2e-2);
  });
}

TEST(EnvironmentLight, ToleratesInvalidDirections) {
  const EnvironmentLight light({.content = sunny_map(16, 8)});
  for (const float x : {0.0F, NAN, HUGE_VALF, -HUGE_VALF, 1e-45F, 3e38F}) {
    for (const float y : {0.0F, NAN, HUGE_VALF, 1e-45F}) {
      EXPECT_TRUE(std::isfinite(light.radiance({x, y, x}).x));
      EXPECT_TRUE(std::isfinite(light.lookup({x, y, x}).pdf));
    }
  }
}

class Maps : public testing::TestWithParam<int> {
 protected:
  static constexpr double kRotation = 0.7;

  static std::shared_ptr<const RadianceMap> make_map() {
    switch (GetParam()) {
      case 0:
        return sunny_map(64, 32);
      case 1:
        return sunny_map(31, 17);
      case 2:
        return map_of(1, 1, [](auto, auto) { return Vec3(2); });
      case 3:
        return map_of(32, 16, [](auto, auto) { return Vec3(0); });
      case 4:
        return map_of(40, 20, [](std::uint32_t x, std::uint32_t y) {
          return Vec3(y < 3 && x > 10 ? 100.0F : 0.0F);
        });
      default:
        return std::make_shared<const RadianceMap>(make_studio());
    }
  }
  const std::shared_ptr<const RadianceMap> map = make_map();
  const EnvironmentLight light{{.content = map, .rotation = kRotation, .intensity = 1.5F}};
};

// Apart from the solid angle, the pdf is bilinear between pixel centers, in longitude and in the
// angle to the axis. It is constant along meridians within half a pixel of the poles. The midpoint
// rule on quarter pixels is therefore exact.
TEST_P(Maps, PdfIntegratesToOne) {
  double integral = 0;
  const std::uint32_t rows = 2 * map->height, columns = 2 * map->width;
  for (std::uint32_t y = 0; y < rows; ++y) {
    const double top = kPi * y / rows, bottom = kPi * (y + 1) / rows, theta = (top + bottom) / 2;
    const bool is_polar = y == 0 || y + 1 == rows;
    const double high = is_polar ? std::cos(top) - std::cos(bottom) : std::sin(theta) * kPi / rows;
    for (std::uint32_t x = 0; x < columns; ++x) {
      const double phi = ((x + 0.5) / columns - 0.5) * 2 * kPi - kRotation;
      const double pdf = light
                             .lookup(DVec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                           std::sin(theta) * std::sin(phi)))
                             .pdf;
      ASSERT_GT(pdf, 0);
      integral += pdf * high * 2 * kPi / columns;
    }
  }
  EXPECT_NEAR(integral, 1, 2e-5);
}

// The tolerances allow for the rounded direction where the map is steep.
TEST_P(Maps, SamplesHaveTheRadianceAndPdfOfTheirDirection) {
  constexpr std::uint32_t kSamples = 20000;
  float brightest = 0;
  for (const Vec3& pixel : map->pixels) brightest = std::max(brightest, 1.5F * pixel.x);
  std::uint32_t moved = 0;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const DirectionSample sample = sample_of(light, sobol(i));
    ASSERT_NEAR(glm::length(sample.wi), 1, 2e-6);
    ASSERT_GT(sample.pdf, 0);
    const EnvironmentLight::Lookup look = light.lookup(sample.wi);
    ASSERT_NEAR(sample.radiance.x, look.radiance.x, 5e-5F * brightest);
    moved += std::abs(sample.pdf - look.pdf) > 2e-3F * sample.pdf ? 1 : 0;
  }
  EXPECT_LE(moved, kSamples / 200);
}

// Radiance / pdf is nearly constant in and near the sun, so no direction has a much larger weight
// than others. Compares the minimum and the maximum over samples in the sun.
TEST(EnvironmentLight, SamplesOfASunHaveEqualWeights) {
  const EnvironmentLight light({.content = sunny_map(64, 32)});
  float least = HUGE_VALF, most = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const DirectionSample sample = sample_of(light, sobol(i));
    if (sample.radiance.y < 1000) continue;
    least = std::min(least, sample.radiance.y / sample.pdf);
    most = std::max(most, sample.radiance.y / sample.pdf);
  }
  EXPECT_GT(most, 0);
  EXPECT_LT(most, 1.2F * least);
}

// Compares the number of samples in each cell of equal solid angle with the integral of the pdf, by
// Pearson's chi-square test.
TEST_P(Maps, SamplesFollowThePdf) {
  constexpr std::size_t kRows = 8, kColumns = 16, kSamples = 100000;
  const auto cell = [](const Vec3& d) {
    const double h = std::clamp((1 - double{d.y}) / 2, 0.0, 1 - 1e-9);
    const double u = std::atan2(double{d.z}, double{d.x}) / (2 * kPi) + 0.5;
    return static_cast<std::size_t>(h * kRows) * kColumns +
           static_cast<std::size_t>(std::min(u, 1 - 1e-9) * kColumns);
  };
  std::vector<double> expected(kRows * kColumns), seen(kRows * kColumns);
  for_sphere(2048, [&](const Vec3& d, double weight) {
    expected[cell(d)] += light.lookup(d).pdf * weight;
  });
  std::mt19937 random(5);
  std::uniform_int_distribution<std::uint32_t> number(0, (1U << 24U) - 1);
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const auto a = static_cast<float>(number(random)), b = static_cast<float>(number(random));
    seen[cell(sample_of(light, {a * 0x1p-24F, b * 0x1p-24F}).wi)] += 1;
  }
  double chi2 = 0;
  std::size_t cells = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double mean = expected[i] * kSamples;
    if (mean < 5) continue;
    chi2 += (seen[i] - mean) * (seen[i] - mean) / mean;
    ++cells;
  }
  const auto freedom = static_cast<double>(cells);
  EXPECT_LT(chi2, freedom + 5 * std::sqrt(2 * freedom));
}

// E[radiance / pdf] is the integral of radiance.
TEST_P(Maps, EstimatesTheIntegral) {
  DVec3 integral(0);
  for_sphere(2048,
             [&](const Vec3& d, double weight) { integral += DVec3(light.radiance(d)) * weight; });
  constexpr std::uint32_t kSamples = 65536;
  DVec3 sum(0), squares(0);
  std::mt19937 random(6);
  std::uniform_real_distribution<float> number(0, 0x0.ffffffp0F);
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const float a = number(random), b = number(random);
    const DirectionSample sample = sample_of(light, {a, b});
    const DVec3 value = DVec3(sample.radiance) / double{sample.pdf};
    sum += value;
    squares += value * value;
  }
  const DVec3 mean = sum / double{kSamples};
  for (glm::length_t i = 0; i < 3; ++i) {
    const double deviation = std::sqrt(std::max(squares[i] / kSamples - mean[i] * mean[i], 0.0));
    EXPECT_NEAR(mean[i], integral[i],
                4.5 * deviation / std::sqrt(double{kSamples}) + 2e-3 * integral[i] + 1e-9);
  }
  const DVec3 weights(0.2126, 0.7152, 0.0722);
  EXPECT_NEAR(light.mean_luminance(), glm::dot(weights, integral) / (4 * kPi),
              2e-2 * light.mean_luminance() + 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, Maps, testing::Range(0, 6));

// If one pixel emits nearly all light, the others must still have a positive probability.
TEST(EnvironmentLight, SamplesDimLightBesideASun) {
  const std::uint32_t width = 512, height = 256;
  const auto map = map_of(width, height, [&](std::uint32_t x, std::uint32_t y) {
    return Vec3(x == 100 && y == 60 ? 1e9F : 0.01F);
  });
  const EnvironmentLight light({.content = map});
  double dim = 0;
  constexpr std::uint32_t kSamples = 1U << 20U;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const DirectionSample sample = sample_of(light, sobol(i));
    ASSERT_GT(sample.pdf, 0);
    if (sample.radiance.x < 0.02F) dim += double{sample.radiance.x} / double{sample.pdf} / kSamples;
  }
  EXPECT_NEAR(dim, 0.01 * 4 * kPi, 0.001 * 4 * kPi * 0.3);
}

TEST(SharedTables, MakeTheTablesOfAMapOnce) {
  SharedTables tables;
  const Environment studio{.content = Studio{}};
  const auto map = sunny_map(32, 16), other = sunny_map(32, 16);
  const auto first = tables.of({.content = map});
  EXPECT_EQ(first->map, map);
  EXPECT_EQ(tables.of({.content = map, .rotation = 1, .intensity = 3}), first);
  EXPECT_EQ(tables.of(studio), SharedTables().of(studio));
  EXPECT_EQ(SharedTables(tables, Scene{}).of({.content = map}), first);
  EXPECT_NE(tables.of({.content = other}), first);
  EXPECT_EQ(tables.of({.content = Vec3(1)}), nullptr);
}

TEST(Studio, IsGrayAndSymmetric) {
  const EnvironmentLight light({.content = Studio{}});
  for_sphere(64, [&](const Vec3& d, double) {
    const Vec3 here = light.radiance(d), there = light.radiance({-d.x, d.y, d.z});
    ASSERT_NEAR(here.x, there.x, 1e-4 * double{here.x});
    ASSERT_EQ(here.x, here.y);
    ASSERT_EQ(here.x, here.z);
    ASSERT_GT(here.x, 0.05);
  });
}

// Checks the exposures of white surfaces that docs/light.md states.
TEST(Studio, ExposesWhite) {
  const EnvironmentLight light({.content = Studio{}});
  const auto shown = [&](const Vec3& n) {
    double irradiance = 0;
    for_sphere(256, [&](const Vec3& d, double weight) {
      irradiance += std::max(double{glm::dot(n, d)}, 0.0) * double{light.radiance(d).x} * weight;
    });
    return 0.8 * irradiance / kPi;
  };
  EXPECT_NEAR(shown({0, 1, 0}), 0.83, 0.05);
  EXPECT_NEAR(shown({0, 0, 1}), 0.62, 0.05);
  EXPECT_NEAR(shown({1, 0, 0}), 0.52, 0.05);
  EXPECT_NEAR(shown({0, 0, -1}), 0.4, 0.05);
  EXPECT_NEAR(shown({0, -1, 0}), 0.25, 0.05);
  EXPECT_NEAR(light.mean_luminance(), 0.66, 0.01);
}

TEST(EnvironmentLight, SeveralSamplesEqualSingleOnes) {
  for (const Environment& environment :
       {Environment{.content = Studio{}}, Environment{.content = Vec3(1, 2, 3)}}) {
    const EnvironmentLight light(environment);
    LaneFloats u[2];
    MapLanes<kShadingLanes> lanes{};
    for (std::uint32_t round = 0; round < 200; ++round) {
      put_numbers(u, 5, round);
      const Lanes asked = round == 0 ? 0xffffU : (round * 2654435761U) >> 16U;
      light.sample(asked, u, lanes);
      for (Lanes rest = asked; rest != 0; rest &= rest - 1) {
        const int lane = std::countr_zero(rest);
        const DirectionSample sample = sample_in(lanes, lane),
                              one = sample_of(light, {u[0][lane], u[1][lane]});
        ASSERT_EQ(sample.wi, one.wi);
        ASSERT_EQ(sample.radiance, one.radiance);
        ASSERT_EQ(sample.pdf, one.pdf);
      }
    }
  }
}

// Includes the poles, the seam, and lanes that are not asked.
TEST(EnvironmentLight, SeveralLookupsEqualSingleOnes) {
  for (const Environment& environment :
       {Environment{.content = Studio{}}, Environment{.content = Vec3(1, 2, 3)},
        Environment{.content = sunny_map(17, 5), .rotation = 2, .intensity = 0.5F}}) {
    const EnvironmentLight light(environment);
    MapLanes<kShadingLanes> lanes{};
    for (std::uint32_t round = 0; round < 300; ++round) {
      const Lanes asked = round == 0 ? 0xffffU : (round * 2654435761U) >> 16U;
      for (int lane = 0; lane < kShadingLanes; ++lane) {
        const auto u = sampling::Sobol(7, 16 * round + static_cast<std::uint32_t>(lane)).pair(0);
        const Vec3 special(float(lane & 1) - 0.5F, float(lane & 2) - 1,
                           (lane & 4) == 0 ? -0.0F : 1e-30F);
        put(lanes.d, lane,
            glm::normalize(round == 0 ? special : Vec3(u.x - 0.5F, u.y - 0.5F, u.x)));
      }
      light.look_up(asked, lanes);
      for (Lanes rest = asked; rest != 0; rest &= rest - 1) {
        const int lane = std::countr_zero(rest);
        const EnvironmentLight::Lookup one = light.lookup(got(lanes.d, lane));
        ASSERT_EQ(got(lanes.radiance, lane), one.radiance) << round << " " << lane;
        ASSERT_EQ(lanes.pdf[lane], one.pdf) << round << " " << lane;
      }
    }
  }
}

// All instruction sets find the same cells and the same light, whether cells are asked or sampled.
TEST(EnvironmentLight, KernelsAgree) {
  const std::shared_ptr<const RadianceMap> map = sunny_map(33, 12);
  const MapDistribution distribution(*map);
  for (std::uint32_t round = 0; round < 100; ++round) {
    LaneFloats u[2];
    put_numbers(u, 3, round);
    MapLanes<kShadingLanes> expected{};
    distribution.select(kAllLanes<kShadingLanes>, u, expected);
    const MapLanes<kShadingLanes> selected = expected;
    kPortableShading.sample_map(distribution.shape(), expected);
    for (const ShadingKernels* kernels : kShadingKernels.available()) {
      MapLanes<kShadingLanes> lanes = selected;
      kernels->sample_map(distribution.shape(), lanes);
      EXPECT_EQ(std::memcmp(&lanes, &expected, sizeof lanes), 0) << kernels->name;
      MapLanes<kShadingLanes> found = lanes;
      kernels->find_map_places(distribution.shape(), found);
      kernels->look_up_map(distribution.shape(), found);
      for (int lane = 0; lane < kShadingLanes; ++lane) {
        EXPECT_NEAR(found.pdf[lane] / lanes.pdf[lane], 1, 1e-2) << kernels->name;
        EXPECT_NEAR(found.radiance[0][lane] / lanes.radiance[0][lane], 1, 1e-2) << kernels->name;
      }
    }
  }
}

}  // namespace
}  // namespace microtrace
