#include "render/sampling/hash.hpp"

#include <microtrace/error.hpp>
#include <microtrace/render.hpp>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Returns values that depend only on the sample's id. Their magnitudes differ so much that a
/// floating-point sum would depend on the order.
class NoiseIntegrator final : public Integrator {
 public:
  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    EXPECT_LE(rays.size(), kRandomBatch);
    EXPECT_EQ(ids.size(), rays.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      using sampling::hash;
      std::uint32_t key = hash(hash(hash(world.seed, ids[i].x), ids[i].y), ids[i].index);
      for (glm::length_t c = 0; c < 3; ++c) {
        key = hash(key, 1);
        samples[i].color[c] =
            std::ldexp(static_cast<float>(key >> 8U), -static_cast<int>(key % 40U) - 8);
      }
      samples[i].alpha = static_cast<float>(key >> 8U) * 0x1p-24F;
    }
  }
  [[nodiscard]] bool is_random() const override { return true; }
};

constexpr ImageSize kPassSize{.width = 21, .height = 18};  // tiles are clipped on both sides

Film drawn(RenderOptions options) {
  const NoiseIntegrator integrator;
  options.integrator = &integrator;
  Scene scene;
  scene.background = Vec3(0.5F, 3, 0.1F);
  return render(scene, PerspectiveCamera{}, kPassSize, options);
}

void expect_equal(const Film& a, const Film& b) {
  ASSERT_EQ(a.size().width, b.size().width);
  ASSERT_EQ(a.size().height, b.size().height);
  for (std::uint32_t y = 0; y < a.size().height; ++y) {
    for (std::uint32_t x = 0; x < a.size().width; ++x)
      ASSERT_EQ(a.row(y)[x], b.row(y)[x]) << x << " " << y;
  }
}

TEST(Passes, GiveTheSameBitsAsOnePass) {
  for (const std::uint32_t n : {1U, 2U, 17U, 100U}) {
    const Film whole = drawn({.threads = 1, .samples = n, .seed = 4});
    expect_equal(whole, drawn({.threads = 3, .samples = n, .seed = 4, .passes = Passes{}}));
  }
}

TEST(Passes, SeedChangesTheNoise) {
  const Film one = drawn({.samples = 4, .seed = 1}), other = drawn({.samples = 4, .seed = 2});
  EXPECT_NE(one.row(0)[0], other.row(0)[0]);
}

// Simulates machines that compute shards in any order, and one that resumes from the merged
// checkpoints.
TEST(Passes, PartsAddUpToTheWhole) {
  const Film whole = drawn({.samples = 50, .transparent = true});
  std::vector<SampleSums> parts;
  for (const SampleRange& part : {SampleRange{37, 50}, SampleRange{0, 11}, SampleRange{11, 30}}) {
    parts.emplace_back();
    (void)drawn({.samples = 50,
                 .passes = Passes{.sums = &parts.back(), .range = part},
                 .transparent = true});
    EXPECT_EQ(parts.back().ranges(), std::vector<SampleRange>{part});
  }
  (parts[0] += parts[1]) += parts[2];
  const Film rest =
      drawn({.samples = 50, .passes = Passes{.sums = parts.data()}, .transparent = true});
  EXPECT_EQ(parts[0].ranges(), (std::vector<SampleRange>{{0, 50}}));
  expect_equal(whole, rest);
  expect_equal(whole, develop(parts[0], Film::Alpha::premultiplied));
}

TEST(Passes, ContinueFromExistingSamples) {
  SampleSums sums;
  std::vector<std::uint32_t> seen;
  const auto note = [&](const SampleSums& so_far) { seen.push_back(so_far.count()); };
  const Film first = drawn({.samples = 20, .passes = Passes{.sums = &sums, .after_each = note}});
  EXPECT_EQ(seen, (std::vector<std::uint32_t>{1, 2, 4, 8, 16, 20}));
  expect_equal(first, drawn({.samples = 20}));
  RenderCounts counts;
  const Film more = drawn({.samples = 45, .passes = Passes{.sums = &sums}, .counts = &counts});
  expect_equal(more, drawn({.samples = 45}));
  EXPECT_EQ(counts.samples, 25U * kPassSize.width * kPassSize.height);
  EXPECT_EQ(counts.samples_per_pixel, 45U);
  EXPECT_EQ(counts.invalid_samples, 0U);
}

TEST(Passes, StopAtTheTimeLimitAfterTheFirst) {
  SampleSums sums;
  double progress = 0;
  const Film film = drawn({.progress =
                               [&](double share) {
                                 progress = share;
                                 return true;
                               },
                           .samples = 4096,
                           .passes = Passes{.sums = &sums, .time_limit = 0}});
  EXPECT_EQ(sums.count(), 1U);
  EXPECT_EQ(progress, 1);
  expect_equal(film, drawn({.samples = 1}));
}

TEST(Passes, CanceledPassesLeaveNoTrace) {
  constexpr std::uint32_t kSamples = 50;
  const Film whole = drawn({.threads = 2, .samples = kSamples});
  for (const int calls : {1, 2, 5, 9, 14, 30}) {
    SampleSums sums;
    int left = calls;
    RenderOptions options{.threads = 2, .samples = kSamples, .passes = Passes{.sums = &sums}};
    options.progress = [&](double) { return --left > 0; };
    EXPECT_THROW((void)drawn(options), Error) << calls;
    EXPECT_LT(sums.count(), kSamples);
    for (const PixelSum& pixel : sums.pixels) ASSERT_EQ(pixel.count, sums.count()) << calls;
    options.progress = nullptr;
    expect_equal(drawn(options), whole);
  }
}

TEST(Passes, CropEqualsThatPartOfTheWhole) {
  const Film whole = drawn({.samples = 9});
  SampleSums sums;
  const Film part =
      drawn({.samples = 9, .passes = Passes{.sums = &sums}, .crop = PixelRect{3, 5, 20, 17}});
  for (std::uint32_t y = 0; y < part.size().height; ++y) {
    for (std::uint32_t x = 0; x < part.size().width; ++x)
      ASSERT_EQ(part.row(y)[x], whole.row(y + 5)[x + 3]);
  }
}

TEST(Passes, RefuseInvalidOptions) {
  SampleSums other;
  (void)drawn({.samples = 2, .passes = Passes{.sums = &other}, .crop = PixelRect{0, 0, 4, 4}});
  const std::vector<RenderOptions> bad = {
      {.samples = 4, .passes = Passes{.sums = &other}},
      {.samples = 4, .passes = Passes{.range = SampleRange{2, 5}}},
      {.samples = 4, .passes = Passes{.range = SampleRange{2, 2}}},
  };
  for (const RenderOptions& options : bad) EXPECT_THROW((void)drawn(options), Error);
  const FlatIntegrator flat;
  EXPECT_THROW((void)render(Scene{}, PerspectiveCamera{}, kPassSize,
                            {.integrator = &flat, .passes = Passes{}}),
               Error);
}

}  // namespace
}  // namespace microtrace
