// Compares the samplers of scattering media with their distributions and with published values.

#include "render/media/free_flight.hpp"
#include "render/media/henyey_greenstein.hpp"
#include "render/media/medium.hpp"
#include "support/shading/chi_square.hpp"
#include "support/shading/h_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(HenyeyGreenstein, CosinesHaveThePdf) {
  constexpr int cells = 64, samples = 200'000, fine = 64;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (const double g : {-0.95, -0.5, -1e-9, 0.0, 1e-4, 0.3, 0.8, 0.99}) {
    std::vector<double> counts(cells), expected(cells);
    double mean = 0, mass = 0;
    for (int i = 0; i < samples; ++i) {
      const double cosine = henyey_greenstein_cosine(g, u(random));
      ASSERT_GE(cosine, -1 - 1e-12);
      ASSERT_LE(cosine, 1 + 1e-12);
      mean += cosine / samples;
      ++counts[static_cast<std::size_t>(std::clamp(int((cosine + 1) / 2 * cells), 0, cells - 1))];
    }
    for (int cell = 0; cell < cells * fine; ++cell) {
      const double cosine = 2 * (cell + 0.5) / (cells * fine) - 1;
      const double part =
          2 * std::numbers::pi * henyey_greenstein_pdf(g, cosine) * 2 / (cells * fine);
      expected[static_cast<std::size_t>(cell / fine)] += part * samples;
      mass += part;
    }
    EXPECT_NEAR(mean, g, 5 / std::sqrt(3.0 * samples)) << "the mean cosine is g";
    // Narrower lobes would need finer cells.
    if (std::abs(g) < 0.95) {
      EXPECT_NEAR(mass, 1, 0.003) << g;
      EXPECT_LT(chi_square_excess(counts, expected), 5) << g;
    }
  }
}

// The ends of the range, where naive formulas cancel or divide by zero.
TEST(HenyeyGreenstein, EndsOfTheRange) {
  for (const double g : {-0.9999, -0.5, 0.0, 0.5, 0.9999}) {
    EXPECT_NEAR(henyey_greenstein_cosine(g, 0), -1, 1e-7) << g;
    EXPECT_NEAR(henyey_greenstein_cosine(g, 1), 1, 1e-7) << g;
  }
  EXPECT_NEAR(henyey_greenstein_cosine(0, 0.75), 0.5, 1e-15);
  EXPECT_NEAR(henyey_greenstein_cosine(1e-12, 0.75), 0.5, 1e-11);
}

TEST(Medium, FollowsItsMaterial) {
  Material m;
  m.volume = Volume{.thickness = 1, .attenuation_distance = 2};
  m.volume->attenuation_color = {0.25F, 1, 0};
  m.volume_scatter = VolumeScatter{.multiscatter_color = {0.5F, 0.5F, 1}, .anisotropy = 1};
  const Medium medium = medium_of(m);
  EXPECT_EQ(medium.extinction, Vec3(1, 0, 15)) << "powers of two per length";
  EXPECT_NEAR(medium.albedo.x, single_scattering_albedo(0.5), 1e-7);
  EXPECT_EQ(medium.albedo.y, 0) << "no extinction, no scattering";
  EXPECT_EQ(medium.albedo.z, 1);
  EXPECT_LT(medium.anisotropy, 1);
  EXPECT_TRUE(medium.scatters());
  m.volume_scatter.reset();
  EXPECT_FALSE(medium_of(m).scatters());
}

TEST(Medium, ColorIsTheAlbedoOfAHalfSpace) {
  EXPECT_EQ(single_scattering_albedo(0), 0);
  EXPECT_NEAR(single_scattering_albedo(1), 1, 1e-9);
  for (const double color : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const HFunction h(single_scattering_albedo(color));
    EXPECT_NEAR(h.mean_reflected(), color, 0.003);
  }
}

// All channels of a flight must have the distribution of their own extinction, whichever channel
// was selected.
TEST(FreeFlight, EachChannelHasItsExtinction) {
  const Medium medium{.extinction = {0.5F, 3, 0}, .albedo = {1, 0.5F, 0}};
  constexpr int samples = 400'000;
  constexpr double kLn2 = std::numbers::ln2;
  const Vec3 throughput(1, 2, 0.5F);
  for (const double end : {0.3, 1.5, kInfinity}) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> u(0, 1);
    DVec3 scattered(0), distance(0), arrived(0);
    double most = 0;
    for (int i = 0; i < samples; ++i) {
      // std::uniform_real_distribution may return 1 in float32.
      const Vec2 chances(std::min(u(random), 0x1.fffffep-1F), std::min(u(random), 0x1.fffffep-1F));
      const FreeFlight flight = sample_free_flight(medium, throughput, end, chances);
      const DVec3 weight = DVec3(flight.weight) / double(samples);
      (flight.distance ? scattered : arrived) += weight;
      if (flight.distance) distance += *flight.distance * weight;
      const DVec3 left = DVec3(throughput) * DVec3(flight.weight);
      most = std::max(most, left.x + left.y + left.z);
    }
    EXPECT_LT(most, 3.5 * (1 + 1e-5)) << "weights never add up to more than the throughput";
    for (int c = 0; c < 3; ++c) {
      const double sigma = medium.extinction[c] * kLn2, albedo = medium.albedo[c];
      const double t = sigma == 0 ? 1 : std::exp(-sigma * end);
      EXPECT_NEAR(arrived[c], t, 0.01) << c << ' ' << end;
      EXPECT_NEAR(scattered[c], albedo * (1 - t), 0.01) << c << ' ' << end;
      if (sigma == 0) continue;
      const double rest = t == 0 ? 0 : (end + 1 / sigma) * t;
      EXPECT_NEAR(distance[c], albedo * (1 / sigma - rest), 0.02 / sigma) << c << ' ' << end;
    }
  }
}

/// The reflected fraction of light that meets a half-space at this angle, by random walks.
double reflected(const Medium& medium, double cosine, int paths) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(0, 0x1.fffffep-1F);
  double sum = 0;
  for (int i = 0; i < paths; ++i) {
    double depth = 0, down = cosine;
    Vec3 throughput(1);
    for (int events = 0; throughput.x > 1e-4F; ++events) {
      const double end = down < 0 ? depth / -down : kInfinity;
      const Vec2 chances(u(random), u(random));
      const FreeFlight flight = sample_free_flight(medium, throughput, end, chances);
      throughput *= flight.weight;
      if (!flight.distance) {
        sum += throughput.x;
        break;
      }
      depth += down * *flight.distance;
      down = henyey_greenstein_cosine(0, u(random));
    }
  }
  return sum / paths;
}

TEST(FreeFlight, HalfSpaceReflectsAsPublished) {
  EXPECT_NEAR(HFunction(0.5)(1), 1.2513, 0.001);
  EXPECT_NEAR(HFunction(0.9)(1), 1.8501, 0.001);
  EXPECT_NEAR(HFunction(1)(1), 2.9078, 0.01);
  for (const float albedo : {0.5F, 0.9F, 0.99F}) {
    const HFunction h(albedo);
    for (const double cosine : {0.15, 0.5, 1.0}) {
      const Medium medium{.extinction = Vec3(1), .albedo = Vec3(albedo)};
      EXPECT_NEAR(reflected(medium, cosine, 30'000), h.reflected(cosine), 0.01)
          << albedo << ' ' << cosine;
    }
  }
}

}  // namespace
}  // namespace microtrace
