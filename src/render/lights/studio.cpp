#include "render/lights/studio.hpp"

#include "scene/trigonometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace microtrace {
namespace {

constexpr std::uint32_t kWidth = 256, kHeight = 128;

enum class Wall { top, side, front, back };

/// A rectangle of light on a wall of the cube [-1, 1]^3 around the scene, with soft edges.
struct Lamp {
  Wall wall;
  double x, y;  ///< centre; on side walls x is towards the front, on top y is
  double half_width, half_height;
  double radiance;
};

constexpr std::array kLamps = {
    Lamp{
        .wall = Wall::top, .x = 0, .y = 0.1, .half_width = 0.7, .half_height = 0.55, .radiance = 5},
    Lamp{.wall = Wall::side,
         .x = 0.35,
         .y = 0.15,
         .half_width = 0.3,
         .half_height = 0.65,
         .radiance = 2.5},
    Lamp{.wall = Wall::front,
         .x = 0.55,
         .y = 0.45,
         .half_width = 0.25,
         .half_height = 0.35,
         .radiance = 3},
    Lamp{
        .wall = Wall::back, .x = 0, .y = 0.3, .half_width = 0.6, .half_height = 0.2, .radiance = 2},
};

/// 1 where the rectangle's edge is further inside than the softness, 0 where it is outside.
double inside(double distance, double half) {
  constexpr double softness = 0.15;
  const double t = std::clamp((half - std::abs(distance)) / softness, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// The left half mirrors the right one: x is not negative.
double radiance(double x, double y, double z) {
  const double reach = std::max({x, std::abs(y), std::abs(z)});
  x /= reach;
  y /= reach;
  z /= reach;
  // Walls that grow lighter from the floor up.
  const double height = 0.5 + 0.5 * y;
  double sum = 0.22 + 0.38 * height;
  for (const Lamp& lamp : kLamps) {
    double across = x, up = y;
    if (lamp.wall == Wall::top) {
      if (y < 1) continue;
      up = z;
    } else if (lamp.wall == Wall::side) {
      if (x < 1 || y >= 1) continue;
      across = z;
    } else if ((lamp.wall == Wall::front ? z : -z) < 1 || y >= 1) {
      continue;
    }
    sum += lamp.radiance * inside(across - lamp.x, lamp.half_width) *
           inside(up - lamp.y, lamp.half_height);
  }
  return sum;
}

}  // namespace

RadianceMap make_studio() {
  RadianceMap map{.width = kWidth, .height = kHeight};
  map.pixels.resize(std::size_t{kWidth} * kHeight);
  std::array<double, kWidth / 2> cosines{}, sines{};
  for (std::size_t i = 0; i < cosines.size(); ++i) {  // from -z over +x to +z: the right half
    const double phi = (static_cast<double>(i) + 0.5) / double{kWidth / 2} * std::numbers::pi;
    cosines[i] = sin_radians(phi);
    sines[i] = -cos_radians(phi);
  }
  for (std::uint32_t row = 0; row < kHeight; ++row) {
    const double theta = (row + 0.5) / kHeight * std::numbers::pi;
    const double r = sin_radians(theta), y = cos_radians(theta);
    Vec3* line = &map.pixels[std::size_t{row} * kWidth];
    for (std::uint32_t i = 0; i < kWidth / 2; ++i) {
      const Vec3 grey(static_cast<float>(radiance(r * cosines[i], y, r * sines[i])));
      line[kWidth / 4 + i] = grey;
      line[(kWidth / 4 - 1 - i + kWidth) % kWidth] = grey;
    }
  }
  return map;
}

}  // namespace microtrace
