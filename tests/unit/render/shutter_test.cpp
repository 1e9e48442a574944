#include "render/sampling/time_slice.hpp"
#include "support/pictures.hpp"

#include <microtrace/error.hpp>
#include <microtrace/shutter.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using sampling::first_sample_in;

/// The slice of each of the first `count` samples of a pixel.
std::vector<std::uint32_t> slices(std::uint32_t count, std::uint32_t key) {
  std::vector<std::uint32_t> result(count, count);
  for (std::uint32_t slice = 0; slice < count; ++slice) {
    const std::uint32_t sample = first_sample_in({.index = slice, .count = count}, key);
    EXPECT_LT(sample, count);
    EXPECT_EQ(result.at(sample), count) << "two slices have the same sample";
    result.at(sample) = slice;
  }
  return result;
}

TEST(TimeSlices, SpreadTheFirstSamplesEvenly) {
  for (const std::uint32_t key : {0U, 1U, 0xdeadbeefU}) {
    const std::vector<std::uint32_t> of_sample = slices(64, key);
    for (std::uint32_t first = 1; first <= 64; first *= 2) {
      std::vector<std::uint32_t> parts;
      for (std::uint32_t k = 0; k < first; ++k) parts.push_back(of_sample[k] * first / 64);
      std::ranges::sort(parts);
      for (std::uint32_t k = 0; k < first; ++k) EXPECT_EQ(parts[k], k) << first;
    }
  }
}

TEST(TimeSlices, MoreSlicesDivideTheSlices) {
  const std::vector<std::uint32_t> fine = slices(32, 5), coarse = slices(8, 5);
  for (std::uint32_t k = 0; k < 8; ++k) EXPECT_EQ(fine[k] / 4, coarse[k]);
}

TEST(TimeSlices, DifferBetweenPixels) {
  EXPECT_NE(slices(64, sampling::pixel_key(0, 3, 4)), slices(64, sampling::pixel_key(0, 4, 4)));
  // The time of sample 0 is uniform over the pixels.
  double mean = 0;
  for (std::uint32_t x = 0; x < 1000; ++x) mean += slices(16, sampling::pixel_key(0, x, 0))[0];
  EXPECT_NEAR(mean / 1000, 7.5, 0.5);
}

constexpr ImageSize kShutterSize{.width = 32, .height = 20};
constexpr double kLeft = 5, kWidth = 6, kWay = 10;  // pixels

/// A square that emits light, moving from left to right in a second. A unit is a pixel.
Scene square_at(double time) {
  Scene scene;
  scene.materials = {{.base_color = {0, 0, 0, 1}, .emissive = Vec3(1)}};
  const auto x = static_cast<float>(kLeft + kWay * time - kShutterSize.width / 2.0);
  scene.objects.push_back(
      {.name = "square",
       .shape = parallelogram({x, -20, -5}, {static_cast<float>(kWidth), 0, 0}, {0, 40, 0}),
       .material = 0});
  scene.environment = Environment{.content = Vec3(0)};
  return scene;
}

const OrthographicCamera kCamera{.height = kShutterSize.height};

Shutter shutter_of_square(const ShutterTimes& times) {
  return {.times = times, .moment = [](double time) {
            return Moment{.scene = PreparedScene(square_at(time)), .camera = kCamera};
          }};
}

Film drawn_open(RenderOptions options, double time = 0) {
  const PathIntegrator path({.max_depth = 2});
  options.integrator = &path;
  return render(square_at(time), kCamera, kShutterSize, options);
}

TEST(Shutter, MovingSquareHasALinearRamp) {
  const Film film =
      drawn_open({.samples = 256, .shutter = shutter_of_square({.open = 0, .close = 1})});
  // The light to the left of x is the integral of the time during which the square covers a point.
  const auto ramp = [](double x) {  // integral of clamp(x / kWay, 0, 1)
    const double t = std::clamp(x / kWay, 0.0, 1.0);
    return kWay * t * t / 2 + std::max(x - kWay, 0.0);
  };
  const auto light = [&](double x) { return ramp(x - kLeft) - ramp(x - kLeft - kWidth); };
  for (std::uint32_t x = 0; x < kShutterSize.width; ++x) {
    double mean = 0;
    for (std::uint32_t y = 0; y < kShutterSize.height; ++y)
      mean += double{film.row(y)[x].y} / kShutterSize.height;
    EXPECT_NEAR(mean, light(x + 1) - light(x), 0.006) << x;
  }
}

TEST(Shutter, SceneAtRestIsTheStillPicture) {
  const std::vector<DVec3> still = pixels_of(drawn_open({.samples = 37, .seed = 3}, 0.25));
  const Shutter rest{.times = {.open = 1, .close = 2, .count = 16}, .moment = [](double) {
                       return Moment{.scene = PreparedScene(square_at(0.25)), .camera = kCamera};
                     }};
  EXPECT_EQ(pixels_of(drawn_open({.samples = 37, .seed = 3, .shutter = rest}, 9)), still);
}

TEST(Shutter, ClosedAtOnceIsTheStillPicture) {
  const Shutter shutter = shutter_of_square({.open = 0.5, .close = 0.5});
  EXPECT_EQ(pixels_of(drawn_open({.samples = 5, .shutter = shutter}, 9)),
            pixels_of(drawn_open({.samples = 5}, 0.5)));
}

TEST(Shutter, CropsThreadsPartsAndPassesGiveTheSameBits) {
  const Shutter shutter = shutter_of_square({.open = 0, .close = 1, .count = 16});
  const Film whole = drawn_open({.threads = 1, .samples = 40, .shutter = shutter});
  EXPECT_EQ(pixels_of(drawn_open({.threads = 3, .samples = 40, .shutter = shutter})),
            pixels_of(whole));
  const PixelRect crop{.x0 = 3, .y0 = 5, .x1 = 19, .y1 = 18};
  const Film part = drawn_open({.samples = 40, .shutter = shutter, .crop = crop});
  for (std::uint32_t y = crop.y0; y < crop.y1; ++y) {
    for (std::uint32_t x = crop.x0; x < crop.x1; ++x)
      ASSERT_EQ(part.row(y - crop.y0)[x - crop.x0], whole.row(y)[x]) << x << " " << y;
  }
  SampleSums sums;
  for (const SampleRange& range : {SampleRange{21, 40}, SampleRange{0, 21}}) {
    (void)drawn_open(
        {.samples = 40, .passes = Passes{.sums = &sums, .range = range}, .shutter = shutter});
  }
  EXPECT_EQ(pixels_of(develop(sums, Film::Alpha::none)), pixels_of(whole));
}

TEST(Shutter, CountsSamplesAndCallsMomentsInOrder) {
  std::vector<double> times;
  Shutter shutter = shutter_of_square({.open = 2, .close = 3, .count = 4});
  shutter.moment = [&, moment = shutter.moment](double time) {
    times.push_back(time);
    return moment(time);
  };
  RenderCounts counts;
  (void)drawn_open({.samples = 7, .shutter = shutter, .counts = &counts});
  EXPECT_EQ(times, (std::vector{2.125, 2.375, 2.625, 2.875}));
  EXPECT_EQ(counts.samples, std::uint64_t{7} * kShutterSize.width * kShutterSize.height);
  EXPECT_EQ(counts.samples_per_pixel, 7U);
}

TEST(Shutter, RefusesInvalidOptions) {
  const auto kind_of = [](const ShutterTimes& times, std::vector<SampledAov> aovs = {}) {
    try {
      (void)drawn_open({.shutter = shutter_of_square(times), .sampled_aovs = std::move(aovs)});
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const ShutterTimes& times :
       {ShutterTimes{.open = 1, .close = 0}, ShutterTimes{.open = kNan, .close = 0},
        ShutterTimes{.open = 0, .close = INFINITY}, ShutterTimes{.close = 1, .count = 0},
        ShutterTimes{.close = 1, .count = 12}, ShutterTimes{.close = 1, .count = 1U << 17U}})
    EXPECT_EQ(kind_of(times), ErrorKind::usage) << times.count;
  EXPECT_EQ(kind_of({.close = 1}, {SampledAov::denoise_normal}), ErrorKind::usage);
  EXPECT_THROW((void)render(square_at(0), kCamera, kShutterSize,
                            {.shutter = shutter_of_square({.close = 1})}),
               Error);  // the flat integrator
}

}  // namespace
}  // namespace microtrace
