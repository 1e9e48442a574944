#include "render/film/sample_pattern.hpp"

#include <microtrace/error.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

TEST(SamplePattern, OneSampleIsTheCenter) {
  const auto pattern = sample_pattern(1);
  ASSERT_EQ(pattern.size(), 1U);
  EXPECT_EQ(pattern[0].x, 0.5);
  EXPECT_EQ(pattern[0].y, 0.5);
}

TEST(SamplePattern, EachRowAndColumnHasOneSample) {
  for (const std::uint32_t n : {2U, 3U, 4U, 7U, 16U, 100U, 1024U}) {
    const auto pattern = sample_pattern(n);
    std::vector<double> rows;
    for (std::uint32_t k = 0; k < n; ++k) {
      EXPECT_EQ(pattern[k].x, (k + 0.5) / n);
      rows.push_back(pattern[k].y);
    }
    std::ranges::sort(rows);
    for (std::uint32_t k = 0; k < n; ++k) EXPECT_EQ(rows[k], (k + 0.5) / n);
  }
}

// Sixteen points must form a (0, 4, 2)-net in base 2: every elementary interval of area 1/16
// contains exactly one.
TEST(SamplePattern, PowersOfTwoAreNets) {
  const auto pattern = sample_pattern(16);
  for (int columns = 1; columns <= 16; columns *= 2) {
    const int rows = 16 / columns;
    std::vector<int> counts(16);
    for (const PixelOffset& p : pattern) {
      ++counts[static_cast<std::size_t>(static_cast<int>(p.x * columns) * rows +
                                        static_cast<int>(p.y * rows))];
    }
    EXPECT_EQ(counts, std::vector<int>(16, 1)) << columns << " columns";
  }
}

constexpr Vec3 kWhite{1}, kBlue{0, 0, 1};

/// Returns a white half plane x < edge. The camera of drawn() shows [-1, 1] x [-1, 1].
Scene half_plane(float edge) {
  Scene scene;
  scene.background = kBlue;
  scene.objects.push_back(
      {.name = "left", .shape = Triangle{{edge, -100, 0}, {edge, 100, 0}, {-200, 0, 0}}});
  return scene;
}

constexpr ImageSize kSize{.width = 20, .height = 20};

Film drawn(const Scene& scene, const RenderOptions& options, ImageSize size = kSize) {
  return render(scene, OrthographicCamera{.pose = {.position = {0, 0, 1}}}, size, options);
}

TEST(Antialiasing, EdgesHaveFractionalCoverage) {
  for (const std::uint32_t n : {1U, 2U, 4U, 9U, 16U, 50U, 256U, 1000U}) {
    // The half plane covers 0.3 of each pixel in column 13.
    Film film = drawn(half_plane(0.3F + 0.03F), {.threads = 2, .samples = n});
    const double share = (film.at(13, 5).x + film.at(13, 14).x) / 2;
    EXPECT_NEAR(share, 0.3, 0.5 / n + 1e-3) << n;
    EXPECT_EQ(film.at(12, 7), kWhite) << n;  // equal samples have exactly their color as mean
    EXPECT_EQ(film.at(14, 7), kBlue) << n;
    EXPECT_EQ(film.at(13, 7).z, 1) << n;
  }
}

// Compares pixels near an edge with the filter's weight on the white side. The edge passes through
// the center of column 13.
TEST(Antialiasing, FilterBlursAnEdgeByItsWeight) {
  Film film = drawn(half_plane(0.35F), {.samples = 256, .filter = PixelFilter::blackman_harris});
  EXPECT_NEAR(film.at(13, 5).x, 0.5, 0.01);
  // For an edge one pixel from the center: 1/2 + t + (a1 sin(2 pi t) + a2/2 sin(4 pi t) + a3/3
  // sin(6 pi t)) / (2 pi a0) with t = 1/3.
  EXPECT_NEAR(film.at(12, 5).x, 0.9934, 0.004);
  EXPECT_NEAR(film.at(14, 5).x, 0.0066, 0.004);
  EXPECT_EQ(film.at(11, 5), kWhite);
  EXPECT_EQ(film.at(15, 5), kBlue);
}

TEST(Antialiasing, AlphaIsCoverageAndColorIsPremultiplied) {
  Film film = drawn(half_plane(0.33F), {.threads = 1, .samples = 16, .transparent = true});
  ASSERT_TRUE(film.has_alpha());
  EXPECT_EQ(film.at(12, 7), kWhite);
  EXPECT_EQ(film.alpha_at(12, 7), 1);
  EXPECT_EQ(film.at(14, 7), Vec3(0));
  EXPECT_EQ(film.alpha_at(14, 7), 0);
  EXPECT_EQ(film.alpha_at(13, 7), 5.0F / 16);
  EXPECT_EQ(film.at(13, 7), Vec3(5.0F / 16));
}

TEST(Antialiasing, TransparentPicturesCompositeToOpaqueOnes) {
  const Scene scene = half_plane(0.33F);
  Film over = drawn(scene, {.samples = 16, .transparent = true});
  Film opaque = drawn(scene, {.samples = 16});
  EXPECT_FALSE(opaque.has_alpha());
  for (std::uint32_t x = 0; x < kSize.width; ++x) {
    EXPECT_EQ(over.at(x, 3) + (1 - over.alpha_at(x, 3)) * scene.background, opaque.at(x, 3)) << x;
  }
}

TEST(Crop, EqualsThatPartOfTheWhole) {
  const ImageSize size{.width = 67, .height = 41};
  for (const std::uint32_t n : {1U, 3U, 16U, 70U}) {
    Film whole = drawn(half_plane(0.1F), {.threads = 1, .samples = n}, size);
    for (const PixelRect& crop : {PixelRect{0, 0, 67, 41}, PixelRect{30, 5, 41, 40},
                                  PixelRect{66, 40, 67, 41}, PixelRect{3, 2, 36, 3}}) {
      Film part = drawn(half_plane(0.1F), {.threads = 3, .samples = n, .crop = crop}, size);
      ASSERT_EQ(part.size().width, crop.x1 - crop.x0);
      ASSERT_EQ(part.size().height, crop.y1 - crop.y0);
      for (std::uint32_t y = crop.y0; y < crop.y1; ++y) {
        for (std::uint32_t x = crop.x0; x < crop.x1; ++x) {
          ASSERT_EQ(part.at(x - crop.x0, y - crop.y0), whole.at(x, y)) << x << " " << y << " " << n;
        }
      }
    }
  }
}

TEST(RenderOptions, OutOfRangeAreUsageErrors) {
  const std::vector<RenderOptions> bad = {{.samples = 0},
                                          {.samples = kMaxSamples + 1},
                                          {.crop = PixelRect{0, 0, 21, 20}},
                                          {.crop = PixelRect{0, 0, 20, 21}},
                                          {.crop = PixelRect{5, 5, 5, 6}},
                                          {.crop = PixelRect{5, 7, 6, 6}}};
  for (const RenderOptions& options : bad) {
    try {
      (void)drawn(Scene{}, options);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
  }
}

/// Returns colors that depend only on the ray, and a coverage of one half.
class DirectionIntegrator final : public Integrator {
 public:
  void trace(const World&, std::span<const Ray> rays, std::span<const SampleId>,
             std::span<Sample> samples) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) samples[i] = {.color = rays[i].o, .alpha = 0.5F};
  }
};

TEST(Integrator, SamplesAreCompositedOverTheBackground) {
  Scene scene;
  scene.background = Vec3(0.5F, 0, 1);
  const DirectionIntegrator integrator;
  Film film = drawn(scene, {.integrator = &integrator});
  EXPECT_EQ(film.at(19, 0), Vec3(0.95F, 0.95F, 1) + 0.5F * scene.background);
}

}  // namespace
}  // namespace microtrace
