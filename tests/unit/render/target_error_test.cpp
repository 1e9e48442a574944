#include "render/film/tile_errors.hpp"
#include "render/sampling/hash.hpp"

#include <microtrace/error.hpp>
#include <microtrace/render.hpp>

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// The result of tossing a coin: 0 or 1.
float tossed(const World& world, const SampleId& id) {
  using sampling::hash;
  return static_cast<float>(hash(hash(hash(world.seed, id.x), id.y), id.index) >> 31U);
}

/// Returns 1 in columns below 16. Returns 0 or 2 with equal probability in columns 16 to 31, and a
/// hundredth of that from column 32 on.
class CoinIntegrator final : public Integrator {
 public:
  void trace(const World& world, std::span<const Ray> /*rays*/, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const float coin = 2 * tossed(world, ids[i]);
      samples[i].color = Vec3(ids[i].x < 16 ? 1 : ids[i].x < 32 ? coin : coin / 100);
      samples[i].alpha = 1;
    }
  }
  [[nodiscard]] bool is_random() const override { return true; }
};

constexpr ImageSize kTargetSize{.width = 48, .height = 20};

Film drawn_to_target(RenderOptions options) {
  const CoinIntegrator integrator;
  options.integrator = &integrator;
  return render(Scene{}, PerspectiveCamera{}, kTargetSize, options);
}

/// Renders with at most `samples` samples per pixel. Continues from `sums` if it has samples.
Film drawn_to(double target, SampleSums& sums, std::uint32_t samples, unsigned threads = 1) {
  return drawn_to_target({.threads = threads,
                          .samples = samples,
                          .passes = Passes{.sums = &sums, .target_error = target}});
}

// A coin flip that gives 0 or 2 has the standard deviation 1. The mean of n flips has an error of
// at most 1 / sqrt(n - 1).
TEST(TileErrors, AreRelativeToPixelAndPictureLuminance) {
  SampleSums sums;
  (void)drawn_to(0, sums, 4096);
  const std::vector<double> errors = tile_errors(sums, false);
  ASSERT_EQ(errors.size(), 18U);  // 6 x 3 tiles
  const double mean = (1 + 1 + 0.01) / 3, s = 1 / std::sqrt(4095.0);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_LT(errors[row * 6], 1e-7);
    EXPECT_NEAR(errors[row * 6 + 2], s / ((1 + mean) / 2), 1e-2 * s);
    EXPECT_NEAR(errors[row * 6 + 4], s / 100 / ((0.01 + mean) / 2), 1e-3 * s);
  }
}

/// Covers half of the picture with a black shadow that lets half of the light through.
class ShadowIntegrator final : public Integrator {
 public:
  void trace(const World& world, std::span<const Ray> /*rays*/, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      samples[i] = {.color = Vec3(0), .alpha = ids[i].x < 24 ? tossed(world, ids[i]) : 0};
    }
  }
  [[nodiscard]] bool is_random() const override { return true; }
};

// Over white, the shadow has a mean of 1/2, the picture one of 3/4, and a sample has the standard
// deviation 1/2.
TEST(TileErrors, CountTheNoiseOfBlackShadowsInPicturesWithAlpha) {
  const ShadowIntegrator integrator;
  SampleSums sums;
  const auto draw = [&](double target, std::uint32_t samples) {
    (void)render(Scene{}, PerspectiveCamera{}, kTargetSize,
                 {.integrator = &integrator,
                  .samples = samples,
                  .passes = Passes{.sums = &sums, .target_error = target},
                  .transparent = true});
  };
  draw(0, 4096);
  const std::vector<double> errors = tile_errors(sums, true);
  const double s = 0.5 / std::sqrt(4095.0);
  EXPECT_NEAR(errors[0], s / ((0.5 + 0.75) / 2), 1e-2 * s);
  EXPECT_EQ(errors[5], 0);
  EXPECT_EQ(tile_errors(sums, false), std::vector<double>(18, 0.0));
  sums = {};
  draw(0.1, 4096);
  EXPECT_EQ(sums.at(0, 0).count, 128U);  // errors at 64 and 128 samples: 0.101, 0.071
  EXPECT_EQ(sums.at(47, 0).count, 32U);
}

TEST(TileErrors, BlackPicturesHaveNone) {
  const SampleSums sums({.width = 9, .height = 3}, {0, 0, 9, 3}, Vec3(0));
  EXPECT_EQ(tile_errors(sums, false), (std::vector<double>{0, 0}));
}

TEST(TileErrors, ConvergedTilesHaveConvergedNeighbors) {
  const PixelRect window{0, 0, 30, 20};  // 4 x 3 tiles
  std::vector<double> errors(12, 0.1);
  EXPECT_EQ(good_tiles(errors, window, 0.1), std::vector<bool>(12, true));
  errors[0] = 0.2;
  std::vector<bool> expected(12, true);
  for (const std::size_t near : {0U, 1U, 4U, 5U}) expected[near] = false;
  EXPECT_EQ(good_tiles(errors, window, 0.1), expected);
  errors[0] = 0.1;
  errors[6] = 0.11;
  expected.assign(12, false);
  for (const std::size_t far : {0U, 4U, 8U}) expected[far] = true;
  EXPECT_EQ(good_tiles(errors, window, 0.1), expected);
}

// At the borders of the coin's columns, converged tiles wait for their neighbors. The coin needs
// about 800 samples, which the passes round up to 1024.
TEST(TargetError, StopsConvergedTiles) {
  SampleSums sums;
  RenderCounts counts;
  const CoinIntegrator integrator;
  (void)render(Scene{}, PerspectiveCamera{}, kTargetSize,
               {.integrator = &integrator,
                .samples = 65536,
                .passes = Passes{.sums = &sums, .target_error = 0.04},
                .counts = &counts});
  EXPECT_EQ(counts.samples_per_pixel, 1024U);
  std::uint64_t samples = 0;
  for (const PixelSum& pixel : sums.pixels) samples += pixel.count;
  EXPECT_EQ(samples, counts.samples);
  for (std::uint32_t y = 0; y < kTargetSize.height; ++y) {
    EXPECT_EQ(sums.at(0, y).count, 32U);
    EXPECT_EQ(sums.at(8, y).count, 1024U);  // tiles beside the coin's columns
    EXPECT_EQ(sums.at(20, y).count, 1024U);
    EXPECT_EQ(sums.at(47, y).count, 32U);
  }
}

TEST(TargetError, SampleLimitIsKept) {
  SampleSums sums;
  (void)drawn_to(1e-9, sums, 100);
  EXPECT_EQ(sums.at(20, 5).count, 100U);
  EXPECT_EQ(sums.count(), 100U);
}

TEST(TargetError, ThreadsAndInterruptionsHaveNoEffect) {
  SampleSums whole, parts;
  const Film film = drawn_to(0.04, whole, 4096);
  for (const std::uint32_t samples : {7U, 32U, 50U, 64U, 700U, 1024U, 1100U})
    (void)drawn_to(0.04, parts, samples, 3);
  const Film again = drawn_to(0.04, parts, 4096, 2);
  EXPECT_EQ(parts.ranges(), whole.ranges());
  EXPECT_EQ(parts.pixels, whole.pixels);
  for (std::uint32_t y = 0; y < kTargetSize.height; ++y) {
    for (std::uint32_t x = 0; x < kTargetSize.width; ++x)
      ASSERT_EQ(film.row(y)[x], again.row(y)[x]);
  }
}

TEST(TargetError, IsNotForShards) {
  EXPECT_THROW(
      (void)drawn_to_target(
          {.samples = 4, .passes = Passes{.range = SampleRange{0, 2}, .target_error = 0.1}}),
      Error);
}

}  // namespace
}  // namespace microtrace
