/// Tests the distributions of samplers that have no pdf to compare with, by Pearson's chi-square
/// test.
#include "render/guiding/hemisphere_bins.hpp"
#include "render/lighting/ground_light.hpp"
#include "render/media/free_flight.hpp"
#include "render/sampling/time_slice.hpp"
#include "render/sampling/warps.hpp"
#include "scene/math/luminance.hpp"
#include "support/pi.hpp"
#include "support/shading/chi_square.hpp"

#include <microtrace/light.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

class UnitSquare {
 public:
  float one() { return u_(random_); }
  Vec2 operator()() {
    const float x = one();
    return {x, one()};
  }

 private:
  std::mt19937 random_{12};
  std::uniform_real_distribution<float> u_{0, 0x0.ffffffp0F};
};

/// Counts points of the unit square in equal cells.
class Counts {
 public:
  static constexpr int kRows = 11, kColumns = 13;
  void add(double x, double y) {
    const auto cell = [](double at, int cells) {
      return std::clamp(int(std::floor(at * cells)), 0, cells - 1);
    };
    ++cells_[std::size_t(cell(y, kRows) * kColumns + cell(x, kColumns))];
    ++all_;
  }
  /// Returns chi_square_excess of a uniform distribution.
  [[nodiscard]] double excess() const {
    return chi_square_excess(cells_, std::vector(cells_.size(), all_ / (kRows * kColumns)));
  }

 private:
  std::vector<double> cells_ = std::vector<double>(kRows * kColumns);
  double all_ = 0;
};

/// Returns the angle of a point, in revolutions from 0 to 1.
double turn(double x, double y) {
  return std::atan2(y, x) / (2 * kPi) + 0.5;
}

constexpr int kSamples = 200'000;

TEST(Distributions, DiskAndCosineHemisphere) {
  UnitSquare u;
  Counts disk, hemisphere;
  for (int i = 0; i < kSamples; ++i) {
    const Vec2 p = sampling::unit_disk(u());
    disk.add(turn(p.x, p.y), glm::dot(p, p));
    const Vec3 d = sampling::cosine_hemisphere(u());
    EXPECT_NEAR(glm::dot(d, d), 1, 1e-6);
    hemisphere.add(turn(d.x, d.y), d.z * d.z);  // the pdf is proportional to d(z^2)
  }
  EXPECT_LT(disk.excess(), 5);
  EXPECT_LT(hemisphere.excess(), 5);
}

// For a uniform point with the weights a, b and c, (1 - a)^2 and b / (b + c) are uniform.
TEST(Distributions, PointsOfATriangle) {
  UnitSquare u;
  Counts counts;
  for (int i = 0; i < kSamples; ++i) {
    const DVec3 w(sampling::triangle_point(u()));
    EXPECT_NEAR(w.x + w.y + w.z, 1, 1e-6);
    EXPECT_GE(w.x, 0);
    EXPECT_GE(w.y, 0);
    counts.add(w.y / (w.y + w.z), (1 - w.x) * (1 - w.x));
  }
  EXPECT_LT(counts.excess(), 5);
}

TEST(Distributions, HemisphereBinsHaveEqualSolidAngles) {
  UnitSquare u;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool is_down : {false, true}) {
      const HemisphereBins bins({.axis = axis, .is_down = is_down});
      Counts counts;
      for (int i = 0; i < kSamples; ++i) {
        const Vec3 d = bins.direction(i % HemisphereBins::kCount, u());
        counts.add(turn(d[(axis + 1) % 3], d[(axis + 2) % 3]), is_down ? -d[axis] : d[axis]);
      }
      EXPECT_LT(counts.excess(), 5) << axis << is_down;
    }
  }
}

// The ground's directions are in proportion to radiance times cosine, with the radiance at the
// center of each of the map's cells.
TEST(Distributions, DirectionsOfTheGround) {
  constexpr int kColumns = 24, kRows = 7;
  auto map = std::make_shared<RadianceMap>(RadianceMap{.width = kColumns, .height = 2 * kRows});
  for (std::uint32_t i = 0; i < kColumns * 2 * kRows; ++i)
    map->pixels.push_back(Vec3(static_cast<float>(1 + i * i % 17), 2, i % 7 == 0 ? 30.0F : 0.0F));
  const EnvironmentLight light({.content = map, .rotation = 0.7, .intensity = 3});
  const HemisphereDistribution distribution(light);
  const auto squared_sine = [](double row) {
    return std::pow(std::sin(row * kPi / (2 * kRows)), 2);
  };
  std::vector<double> counts(kRows * kColumns), expected(counts.size());
  double sum = 0;
  for (int row = 0; row < kRows; ++row) {
    const double s = squared_sine(row + 0.5);
    for (int column = 0; column < kColumns; ++column) {
      const double phi = 2 * kPi * (column + 0.5) / kColumns;
      const DVec3 d(std::sqrt(s) * std::cos(phi), std::sqrt(1 - s), std::sqrt(s) * std::sin(phi));
      double& part = expected[std::size_t(row * kColumns + column)];
      part =
          double{luminance(light.radiance(Vec3(d)))} * (squared_sine(row + 1) - squared_sine(row));
      sum += part;
    }
  }
  for (double& part : expected) part *= kSamples / sum;
  UnitSquare u;
  std::array<Counts, 2> within;  // within cells
  for (int i = 0; i < kSamples; ++i) {
    const DVec3 d(distribution.sample(u()));
    EXPECT_GE(d.y, 0);
    const double s = d.x * d.x + d.z * d.z;
    const double row = std::min(std::asin(std::min(std::sqrt(s), 1.0)) / kPi * 2 * kRows, 6.999999);
    double column = std::atan2(d.z, d.x) / (2 * kPi) * kColumns;
    if (column < 0) column += kColumns;
    column = std::min(column, kColumns - 1e-9);
    ++counts[std::size_t(int(row) * kColumns + int(column))];
    const double low = squared_sine(std::floor(row)), high = squared_sine(std::floor(row) + 1);
    within[std::size_t(i % 2)].add(column - std::floor(column), (s - low) / (high - low));
  }
  EXPECT_LT(chi_square_excess(counts, expected), 5);
  for (const Counts& part : within) EXPECT_LT(part.excess(), 5);
}

TEST(Distributions, LightsOfTheGround) {
  Scene scene;
  scene.lights = {
      {.name = "sun", .light = DirectionalLight{.direction = {0, -1, 0}, .color = Vec3(2)}},
      {.name = "slanting",
       .light = DirectionalLight{.direction = {0.6, -0.8, 0}, .color = {1, 2, 3}}},
      {.name = "below", .light = DirectionalLight{.direction = {0, 1, 0}, .color = Vec3(9)}},
      {.name = "lamp", .light = PointLight{.position = {1, 2, 2}, .color = Vec3(30)}}};
  const EnvironmentLight sky({.content = Vec3(0.5F)});
  const GroundLight ground(scene, &sky);
  const double slanting = 0.8 * (0.2126 * 1 + 0.7152 * 2 + 0.0722 * 3);
  const double lamp = 30.0 / 9 * (2.0 / 3);
  // The uniform sky has radiance 1/2.
  std::vector<double> counts(4), expected{kPi / 2, 2, slanting, lamp};
  const double sum = kPi / 2 + 2 + slanting + lamp;
  for (double& part : expected) part *= kSamples / sum;
  UnitSquare u;
  for (int i = 0; i < kSamples; ++i) {
    const auto sample = ground.sample(Vec3(0), u.one(), u());
    ASSERT_TRUE(sample);
    const Vec3 d = sample->to_light;
    const bool is_sun = d == Vec3(0, 1, 0);
    const bool is_slanting = glm::distance(d, Vec3(-0.6F, 0.8F, 0)) < 1e-5F;
    ++counts[!sample->is_far ? 3U : is_sun ? 1U : is_slanting ? 2U : 0U];
  }
  EXPECT_LT(chi_square_excess(counts, expected), 5);
}

// Distances have the mixture of the channels' exponential distributions.
TEST(Distributions, FreeFlights) {
  const Medium medium{.extinction = {0.5F, 3, 0}, .albedo = {1, 0.5F, 0}};
  const DVec3 throughput(1, 2, 0.5), share = throughput / 3.5;
  constexpr double kEnd = 1.5;
  constexpr int kCells = 30;
  std::vector<double> counts(kCells + 1), expected(counts.size());
  const auto below = [&](double t) {
    double sum = 0;
    for (int c = 0; c < 3; ++c)
      sum += share[c] * -std::expm1(-std::numbers::ln2 * double{medium.extinction[c]} * t);
    return sum;
  };
  for (int i = 0; i < kCells; ++i)
    expected[std::size_t(i)] =
        kSamples * (below(kEnd * (i + 1) / kCells) - below(kEnd * i / kCells));
  expected.back() = kSamples * (1 - below(kEnd));
  UnitSquare u;
  for (int i = 0; i < kSamples; ++i) {
    const FreeFlight flight = sample_free_flight(medium, Vec3(throughput), kEnd, u());
    ++counts[flight.distance ? std::size_t(*flight.distance / kEnd * kCells) : counts.size() - 1];
  }
  EXPECT_LT(chi_square_excess(counts, expected), 5);
}

// The slices of one sample of many pixels are independent.
TEST(Distributions, SlicesOfTheShutter) {
  constexpr std::uint32_t kSlices = 16, kWidth = 160, kHeight = 128;
  for (const std::uint32_t wanted : {0U, 1U, 11U}) {
    std::vector<double> counts(kSlices);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        const std::uint32_t key = sampling::pixel_key(3, x, y);
        for (std::uint32_t slice = 0; slice < kSlices; ++slice) {
          if (sampling::first_sample_in({.index = slice, .count = kSlices}, key) == wanted)
            ++counts[slice];
        }
      }
    }
    const std::vector<double> expected(kSlices, double{kWidth} * kHeight / kSlices);
    EXPECT_LT(chi_square_excess(counts, expected), 5) << wanted;
  }
}

}  // namespace
}  // namespace microtrace
