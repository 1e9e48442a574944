#include "render/film/pixel_filter.hpp"
#include "render/lanes/dispatch.hpp"
#include "render/samples/pixel_adder.hpp"
#include "render/sampling/sobol.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

TEST(FilmKernels, SamplePositionsOfTheFilter) {
  std::array<std::uint32_t, kShadingLanes> keys, indices;
  for (const PixelFilter which : {PixelFilter::box, PixelFilter::blackman_harris}) {
    const FilterSampler filter(which);
    for (const ShadingKernels* kernels : kShadingKernels.available()) {
      for (std::uint32_t round = 0; round < 100; ++round) {
        for (std::uint32_t i = 0; i < kShadingLanes; ++i) {
          keys[i] = sampling::pixel_key(round, i, 7);
          indices[i] = round * i;
        }
        std::array<double, kShadingLanes> x, y;
        kernels->sample_positions(keys.data(), indices.data(), 3, filter.table(), x.data(),
                                  y.data());
        for (std::size_t i = 0; i < kShadingLanes; ++i) {
          const auto u = sampling::Sobol(keys[i], indices[i]).pair(3);
          const PixelOffset expected = filter(u.x, u.y);
          EXPECT_EQ(x[i], expected.x) << kernels->name;
          EXPECT_EQ(y[i], expected.y) << kernels->name;
        }
      }
    }
  }
}

/// Samples of many magnitudes, and some that the kernels leave to PixelSum::add.
std::vector<Sample> samples_of(std::size_t count, std::mt19937& random) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  constexpr std::array kSpecial = {
      0.0F,    -0.0F,   1.0F,   -0.25F,    1e-42F,     1e-20F,
      0x1p19F, 0x1p21F, -3e30F, kInfinite, -kInfinite, std::numeric_limits<float>::quiet_NaN()};
  std::uniform_real_distribution<float> number(0, 2);
  std::uniform_int_distribution<std::size_t> special(0, 20 * kSpecial.size());
  const auto draw = [&] {
    const std::size_t which = special(random);
    return which < kSpecial.size() ? kSpecial[which] : number(random);
  };
  std::vector<Sample> samples(count);
  for (Sample& sample : samples) sample = {.color = {draw(), draw(), draw()}, .alpha = draw() / 2};
  return samples;
}

// Any number of pixels and samples, also with gaps, gives the sums of single samples.
TEST(FilmKernels, SumSamplesLikePixelSums) {
  std::mt19937 random(1);
  for (const ShadingKernels* kernels : kShadingKernels.available()) {
    for (const std::size_t pixels : {1U, 7U, 16U, 17U, 40U, 64U}) {
      for (const Vec3 background : {Vec3(0), Vec3(0.25F, 3, 1e12F)}) {
        std::vector<PixelSum> sums(pixels), expected(pixels);
        std::vector<std::size_t> places(pixels);
        for (std::size_t i = 0; i < pixels; ++i) places[i] = pixels - 1 - i;
        PixelAdder adder(*kernels, background, sums, places);
        std::uint64_t count = 0, invalid = 0;
        for (const std::size_t each : {1U, 2U, 5U, 16U}) {
          for (const bool has_gaps : {false, true}) {
            std::vector<std::size_t> order;
            while (order.size() + each * pixels <= kRandomBatch) {
              for (std::size_t i = 0; i < each * pixels; ++i) {
                if (!has_gaps || random() % 50 != 0) order.push_back(i / each);
              }
            }
            const std::vector<Sample> samples = samples_of(order.size(), random);
            adder.add({.pixels = order, .samples = samples});
            for (std::size_t i = 0; i < samples.size(); ++i, ++count) {
              const auto& [color, alpha] = samples[i];
              if (!expected[places[order[i]]].add(color, alpha, background)) ++invalid;
            }
          }
        }
        EXPECT_EQ(sums, expected) << kernels->name << " " << pixels;
        EXPECT_EQ(adder.samples(), count);
        EXPECT_EQ(adder.invalid(), invalid);
        EXPECT_GT(invalid, 0U);
      }
    }
  }
}

}  // namespace
}  // namespace microtrace
