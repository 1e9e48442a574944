#include "render/lights/environment/studio.hpp"

#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace microtrace {
namespace {

constexpr std::uint32_t kWidth = 256, kHeight = 128;

enum class Wall { top, side, front, back };

/// A rectangular area light on a wall of the cube [-1, 1]^3 around the scene, with soft edges.
struct Lamp {
  Wall wall;
  double x, y;  ///< center; x points to the front on side walls, and so does y on the top
  double half_width, half_height;
  double radiance;
};

// A white surface with reflectance 0.8 reflects radiance of about 0.8 if it faces up, 0.6 if it
// faces the front, and 0.25 if it faces down. The area lights are visible in metals, but not bright
// enough to cause much noise.
constexpr std::array<Lamp, 4> kLamps = {{{Wall::top, 0, 0.25, 0.5, 0.4, 3.2},
                                         {Wall::side, 0.45, 0.25, 0.28, 0.6, 2.5},
                                         {Wall::front, 0.5, 0.4, 0.27, 0.45, 2.3},
                                         {Wall::back, 0, 0.45, 0.7, 0.2, 2.5}}};

/// 1 inside the rectangle and 0 outside, with a soft edge, for one axis. `distance` is the distance
/// from the center, and `half` half the width.
double inside(double distance, double half) {
  constexpr double kSoftness = 0.2;
  const double t = std::clamp((half - std::abs(distance)) / kSoftness, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// The studio's radiance from the direction (x, y, z). x must not be negative; the left half
/// mirrors the right half.
double radiance(double x, double y, double z) {
  const double reach = std::max({x, std::abs(y), std::abs(z)});
  x /= reach;
  y /= reach;
  z /= reach;
  // Walls are brighter toward the top.
  const double height = 0.5 + 0.5 * y;
  double sum = 0.28 + 0.22 * height;
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
  constexpr std::uint32_t kHalf = kWidth / 2;
  std::array<double, kHalf> cosines{}, sines{};
  for (std::size_t i = 0; i < cosines.size(); ++i) {  // the right half, from -z over +x to +z
    const double phi = (static_cast<double>(i) + 0.5) / double{kHalf} * std::numbers::pi;
    cosines[i] = sin_radians(phi);
    sines[i] = -cos_radians(phi);
  }
  for (std::uint32_t row = 0; row < kHeight; ++row) {
    const double theta = (row + 0.5) / kHeight * std::numbers::pi;
    const double r = sin_radians(theta), y = cos_radians(theta);
    Vec3* line = &map.pixels[std::size_t{row} * kWidth];
    for (std::uint32_t i = 0; i < kWidth / 2; ++i) {
      const Vec3 gray(static_cast<float>(radiance(r * cosines[i], y, r * sines[i])));
      line[kWidth / 4 + i] = gray;
      line[(kWidth / 4 - 1 - i + kWidth) % kWidth] = gray;
    }
  }
  return map;
}

}  // namespace microtrace
