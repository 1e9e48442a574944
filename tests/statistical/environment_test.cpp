// Compares light from environment maps with quadrature that uses an independent float64 lookup of
// the map.

#include "support/pi.hpp"
#include "support/shading/scattering.hpp"

#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Returns a map of a sky that is bluer at the top, a ground, and a sun of a few pixels.
std::shared_ptr<const RadianceMap> sky() {
  RadianceMap map{.width = 48, .height = 24};
  for (std::uint32_t y = 0; y < map.height; ++y) {
    for (std::uint32_t x = 0; x < map.width; ++x) {
      const float h = static_cast<float>(y) / 24;
      Vec3 color = y < 12 ? Vec3(0.4F, 0.5F + 0.2F * h, 1.2F - h) : Vec3(0.2F, 0.15F, 0.1F);
      if (x >= 30 && x < 33 && y >= 5 && y < 7) color = Vec3(60, 50, 40);
      map.pixels.push_back(color);
    }
  }
  return std::make_shared<const RadianceMap>(std::move(map));
}

/// Returns the map's radiance as defined in environment.hpp.
DVec3 lookup(const RadianceMap& map, const DVec3& d) {
  const double u = std::atan2(d.z, d.x) / (2 * kPi) + 0.5, v = std::acos(d.y) / kPi;
  const double x = u * map.width - 0.5, y = v * map.height - 0.5;
  const double fx = x - std::floor(x), fy = y - std::floor(y);
  const auto pixel = [&](double column, double row) {
    const auto width = static_cast<std::int64_t>(map.width);
    const auto i = (static_cast<std::int64_t>(column) + width) % width;
    const auto j = static_cast<std::int64_t>(std::clamp(row, 0.0, map.height - 1.0));
    return DVec3(map.pixels[static_cast<std::size_t>(j * width + i)]);
  };
  const double left = std::floor(x), above = std::floor(y);
  return (1 - fy) * ((1 - fx) * pixel(left, above) + fx * pixel(left + 1, above)) +
         fy * ((1 - fx) * pixel(left, above + 1) + fx * pixel(left + 1, above + 1));
}

/// Returns the reflected radiance of a wall with normal n, seen along n. Integrates the product of
/// radiance, cosine and reflectance.
DVec3 reflected(const RadianceMap& map, double rotation, const DVec3& n, float albedo) {
  const bsdf::Scattering bsdf({.base_color = Vec3(albedo)}, {0, 0, 1});
  constexpr int kRows = 512;
  DVec3 sum(0);
  for (int j = 0; j < kRows; ++j) {
    const double y = 1 - (2 * j + 1.0) / kRows, r = std::sqrt(1 - y * y);
    for (int i = 0; i < 2 * kRows; ++i) {
      const double phi = (i + 0.5) / kRows * kPi;
      const DVec3 d(r * std::cos(phi), y, r * std::sin(phi));
      const double cosine = glm::dot(n, d);
      if (cosine <= 0) continue;
      const double c = std::cos(rotation), s = std::sin(rotation);
      const DVec3 in_map(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
      // The BSDF value includes the cosine.
      const Vec3 local(DVec3(std::sqrt(std::max(1 - cosine * cosine, 0.0)), 0, cosine));
      sum += lookup(map, in_map) * double{bsdf.evaluate(local).value.x};
    }
  }
  return sum * (2 * kPi / kRows / kRows);
}

/// Renders a wall with this normal and returns the mean of the picture.
DVec3 seen(const std::shared_ptr<const RadianceMap>& map, double rotation, const DVec3& n,
           float albedo) {
  Scene scene;
  scene.materials = {{.base_color = {albedo, albedo, albedo, 1}}};
  scene.objects.push_back(
      {.name = "wall", .shape = Disc{.center = Vec3(0), .normal = Vec3(n), .radius = 10}});
  scene.objects[0].material = 0;
  scene.environment = Environment{.content = map, .rotation = rotation, .intensity = 0.5F};
  const DVec3 up = std::abs(n.y) > 0.9 ? DVec3(0, 0, 1) : DVec3(0, 1, 0);
  const OrthographicCamera camera{.pose = {.position = n, .direction = -n, .up = up},
                                  .height = 0.01};
  const PathIntegrator path;
  constexpr std::uint32_t kSide = 16;
  const Film film = render(scene, camera, {.width = kSide, .height = kSide},
                           {.integrator = &path, .samples = 64});
  DVec3 sum(0);
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (const Vec3& pixel : film.row(y)) sum += DVec3(pixel);
  }
  return sum / double{kSide * kSide};
}

class Walls : public testing::TestWithParam<DVec3> {};

TEST_P(Walls, ReflectTheMap) {
  const auto map = sky();
  for (const double rotation : {0.0, 2.1}) {
    const DVec3 wanted = 0.5 * reflected(*map, rotation, GetParam(), 0.6F);
    const DVec3 got = seen(map, rotation, GetParam(), 0.6F);
    for (glm::length_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], wanted[i], 0.01 * wanted[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Walls,
                         testing::Values(DVec3(0, 1, 0), DVec3(1, 0, 0), DVec3(0, 0, -1),
                                         DVec3(0, -1, 0), DVec3(-0.6, 0.64, 0.48)));

// The camera must see the map itself, filtered over each pixel.
TEST(EnvironmentBackground, IsTheMap) {
  const auto map = sky();
  Scene scene;
  scene.objects.push_back({.name = "far", .shape = Sphere{{0, -1e6F, 0}, 1}});
  scene.environment = Environment{.content = map, .is_background = true};
  const EnvironmentCamera camera{
      .pose = {.position = DVec3(0), .direction = {1, 0, 0}, .up = {0, 1, 0}}};
  const PathIntegrator path;
  const Film film =
      render(scene, camera, {.width = 48, .height = 24}, {.integrator = &path, .samples = 256});
  for (std::uint32_t y = 0; y < 11; ++y) {
    for (std::uint32_t x = 0; x < 48; ++x) {
      if (x >= 28 && x < 35 && y >= 3 && y < 9)
        continue;  // skips pixels near the sun, where the map is steep
      EXPECT_NEAR(film.row(y)[x].z, map->pixels[y * 48 + x].z, 0.02) << x << ' ' << y;
    }
  }
}

}  // namespace
}  // namespace microtrace
