#include "render/textures/texture_map.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr TextureFootprint kCloseUp{};  // smaller than a pixel

/// Returns a one-row image with these gray levels from left to right.
Image strip(std::vector<std::uint8_t> grays) {
  return {.width = static_cast<std::uint32_t>(grays.size()),
          .height = 1,
          .channels = 1,
          .samples = std::move(grays)};
}

Sampler sampler(Wrap wrap, Filter filter) {
  return {.wrap_s = wrap, .wrap_t = wrap, .magnification = filter, .mip = MipFilter::none};
}

double gray(const Image& image, const Sampler& how, double u,
            const TextureFootprint& size = kCloseUp) {
  const DVec4 color = TextureMap(image, how, ColorEncoding::linear).look_up({u, 0.5}, size);
  EXPECT_EQ(color.x, color.y);
  EXPECT_EQ(color.x, color.z);
  EXPECT_EQ(color.w, 1);
  return color.x * 255;
}

TEST(TextureMap, NearestSelectsTheContainingPixel) {
  const Image image = strip({10, 20, 30, 40});
  const Sampler nearest = sampler(Wrap::clamp_to_edge, Filter::nearest);
  EXPECT_NEAR(gray(image, nearest, 0), 10, 1e-5);
  EXPECT_NEAR(gray(image, nearest, 0.2499), 10, 1e-5);
  EXPECT_NEAR(gray(image, nearest, 0.25), 20, 1e-5);
  EXPECT_NEAR(gray(image, nearest, 1), 40, 1e-5);
}

TEST(TextureMap, LinearInterpolatesBetweenCenters) {
  const Image image = strip({10, 20, 30, 40});
  const Sampler linear = sampler(Wrap::clamp_to_edge, Filter::linear);
  EXPECT_NEAR(gray(image, linear, 0.125), 10, 1e-5);
  EXPECT_NEAR(gray(image, linear, 0.25), 15, 1e-5);
  EXPECT_NEAR(gray(image, linear, 0.03125 + 0.125), 11.25, 1e-5);
  EXPECT_NEAR(gray(image, linear, 0), 10, 1e-5);
}

TEST(TextureMap, WrapModesContinueTheImage) {
  const Image image = strip({10, 20, 30, 40});
  const auto pixel = [&](Wrap wrap, double u) {
    return std::round(gray(image, sampler(wrap, Filter::nearest), u));
  };
  EXPECT_EQ(pixel(Wrap::repeat, 1.3), 20);
  EXPECT_EQ(pixel(Wrap::repeat, -0.1), 40);
  EXPECT_EQ(pixel(Wrap::mirrored_repeat, 1.1), 40);
  EXPECT_EQ(pixel(Wrap::mirrored_repeat, 1.9), 10);
  EXPECT_EQ(pixel(Wrap::mirrored_repeat, -0.3), 20);
  EXPECT_EQ(pixel(Wrap::mirrored_repeat, 2.3), 20);
  EXPECT_EQ(pixel(Wrap::clamp_to_edge, 7), 40);
  EXPECT_EQ(pixel(Wrap::clamp_to_edge, -7), 10);
  const auto edge = [&](Wrap wrap) { return gray(image, sampler(wrap, Filter::linear), 0); };
  EXPECT_NEAR(edge(Wrap::repeat), 25, 1e-5);
  EXPECT_NEAR(edge(Wrap::mirrored_repeat), 10, 1e-5);
}

TEST(TextureMap, HugeCoordinatesStayInTheImage) {
  const Image image = strip({10, 20});
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
    for (const double u : {1e300, -1e300, 1e17, std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()}) {
      const double value = gray(image, sampler(wrap, Filter::linear), u);
      EXPECT_TRUE(value >= 9.99 && value <= 20.01) << u;
      (void)gray(image, Sampler{}, 0.3, {.dx = {u, 0}, .dy = {0, u}});
    }
  }
}

TEST(TextureMap, SrgbIsDecodedBeforeItIsFiltered) {
  const Image image{.width = 2,
                    .height = 1,
                    .channels = 4,
                    .samples = std::vector<std::uint8_t>{0, 0, 0, 0, 255, 188, 0, 255}};
  const TextureMap map(image, sampler(Wrap::clamp_to_edge, Filter::linear), ColorEncoding::srgb);
  const DVec4 middle = map.look_up({0.5, 0.5}, kCloseUp);
  EXPECT_NEAR(middle.x, 0.5, 1e-7);
  EXPECT_NEAR(middle.y, std::pow((188 / 255.0 + 0.055) / 1.055, 2.4) / 2, 1e-7);
  EXPECT_NEAR(middle.w, 0.5, 1e-7) << "alpha is linear";
}

TEST(TextureMap, KeepsSixteenBits) {
  const Image image{.width = 1,
                    .height = 1,
                    .channels = 2,
                    .samples = std::vector<std::uint16_t>{257 * 100 + 1, 1}};
  const DVec4 color = TextureMap(image, Sampler{}, ColorEncoding::linear).look_up({0, 0}, kCloseUp);
  EXPECT_NEAR(color.z, 25701 / 65535.0, 1e-8);
  EXPECT_NEAR(color.w, 1 / 65535.0, 1e-10);
}

/// Returns an 8 x 8 checkerboard of black and white pixels.
Image checker() {
  std::vector<std::uint8_t> samples;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) samples.push_back((x + y) % 2 == 0 ? 255 : 0);
  }
  return {.width = 8, .height = 8, .channels = 1, .samples = samples};
}

TEST(TextureMap, SmallChecksMergeToTheirMean) {
  const Image image = checker();
  const TextureMap map(image, Sampler{}, ColorEncoding::srgb);
  for (const double step : {0.25, 0.3, 1.0, 100.0}) {
    const DVec4 color = map.look_up({0.3, 0.6}, {.dx = {step, 0}, .dy = {0, step}});
    EXPECT_NEAR(color.x, 0.5, 1e-5) << step;
  }
  const DVec4 own = map.look_up({0.5 / 8, 0.5 / 8}, {.dx = {0.125, 0}, .dy = {0, 0.125}});
  EXPECT_EQ(own.x, 1) << "one pixel a sample";
}

TEST(TextureMap, WithoutMipMapsUsesTheBaseLevel) {
  const Image image = checker();
  Sampler how{.minification = Filter::nearest, .mip = MipFilter::none};
  const TextureMap map(image, how, ColorEncoding::srgb);
  EXPECT_EQ(map.look_up({0.5 / 8, 0.5 / 8}, {.dx = {1, 0}, .dy = {0, 1}}).x, 1);
  EXPECT_EQ(map.look_up({1.4 / 8, 0.5 / 8}, {.dx = {1, 0}, .dy = {0, 1}}).x, 0);
}

TEST(TextureMap, ObliqueSurfacesAreFilteredAnisotropically) {
  // Stripes two pixels wide stay sharp if the footprint is elongated along them.
  std::vector<std::uint8_t> samples;
  for (int i = 0; i < 16 * 16; ++i) samples.push_back(i % 4 < 2 ? 255 : 0);
  const Image image{.width = 16, .height = 16, .channels = 1, .samples = samples};
  const TextureMap map(image, Sampler{}, ColorEncoding::linear);
  const double column = 1.0 / 16;
  EXPECT_NEAR(map.look_up({column, 0.5}, {.dx = {column, 0}, .dy = {0, 8 * column}}).x, 1, 1e-5);
  EXPECT_NEAR(map.look_up({column, 0.5}, {.dx = {8 * column, 0}, .dy = {0, column}}).x, 0.5, 0.1);
}

TEST(TextureMap, MipMapsOfOddSizesWeightAllPixelsEqually) {
  const Image image = strip({0, 0, 0, 0, 255});
  EXPECT_NEAR(gray(image, Sampler{}, 0.5, {.dx = {100, 0}, .dy = {0, 100}}), 51, 0.01);
  const Image three = strip({255, 0, 0});
  EXPECT_NEAR(gray(three, Sampler{}, 0.5, {.dx = {100, 0}, .dy = {0, 100}}), 85, 0.01);
}

}  // namespace
}  // namespace microtrace
