#include <microtrace/dataset.hpp>
#include <microtrace/error.hpp>

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Returns the sine of the elevation.
double height(const DatasetView& view) {
  return std::sin(std::get<View>(view.camera).elevation * std::numbers::pi / 180);
}

DVec3 direction(const DatasetView& view) {
  const double azimuth = std::get<View>(view.camera).azimuth * std::numbers::pi / 180;
  const double z = height(view), r = std::sqrt(1 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

TEST(DatasetViews, OrbitsAreEquallySpaced) {
  const std::vector<DatasetView> views = orbit_views(8, -20);
  ASSERT_EQ(views.size(), 8U);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(std::get<View>(views[i].camera).azimuth, 45.0 * static_cast<double>(i));
    EXPECT_EQ(std::get<View>(views[i].camera).elevation, -20);
  }
}

// Each zone of the same height has the same area, and so has each sector of the same angle.
TEST(DatasetViews, HemispheresAreCoveredEvenly) {
  constexpr std::uint32_t kCount = 1000;
  const std::vector<DatasetView> views = hemisphere_views(kCount);
  std::array<int, 10> zones{}, sectors{};
  DVec3 sum(0);
  for (const DatasetView& view : views) {
    const View& at = std::get<View>(view.camera);
    EXPECT_GT(at.elevation, 0);
    EXPECT_GE(at.azimuth, 0);
    EXPECT_LT(at.azimuth, 360);
    ++zones.at(static_cast<std::size_t>(height(view) * 10));
    ++sectors.at(static_cast<std::size_t>(at.azimuth / 36));
    sum += direction(view);
  }
  for (const int zone : zones) EXPECT_NEAR(zone, 100, 1);
  for (const int sector : sectors) EXPECT_NEAR(sector, 100, 3);
  EXPECT_NEAR(sum.x / kCount, 0, 0.01);
  EXPECT_NEAR(sum.y / kCount, 0, 0.01);
  EXPECT_NEAR(sum.z / kCount, 0.5, 0.001);
}

TEST(DatasetViews, RandomDirectionsAreUniform) {
  constexpr std::uint32_t kCount = 20000;
  DVec3 sum(0), squares(0);
  for (const DatasetView& view : random_views(kCount, 3)) {
    const DVec3 d = direction(view);
    sum += d;
    squares += d * d;
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(sum[k] / kCount, 0, 0.02) << k;
    EXPECT_NEAR(squares[k] / kCount, 1 / 3.0, 0.01) << k;
  }
}

TEST(DatasetViews, RandomDirectionsDependOnSeedAndIndexOnly) {
  const std::vector<DatasetView> few = random_views(3, 5), many = random_views(9, 5),
                                 others = random_views(3, 6);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(direction(few[i]), direction(many[i]));
    EXPECT_NE(direction(few[i]), direction(others[i]));
  }
}

TEST(DatasetFileName, FillsInFields) {
  EXPECT_EQ(dataset_file_name("{view}", "s", 12, "n"), "12");
  EXPECT_EQ(dataset_file_name("{scene}/{view:06d}_{name}", "s", 12, "n"), "s/000012_n");
  EXPECT_EQ(dataset_file_name("{view:01d}", "s", 123, ""), "123");
}

TEST(DatasetFileName, RefusesOtherPatterns) {
  for (const char* pattern : {"", "x", "{view", "{views}", "{view:d}", "{view:00d}", "{view:06x}",
                              "/{view}", "../{view}", "a/../../{view}"}) {
    EXPECT_THROW(static_cast<void>(dataset_file_name(pattern, "s", 1, "n")), Error) << pattern;
  }
}

}  // namespace
}  // namespace microtrace
