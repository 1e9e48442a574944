#include "io/gltf/framing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

namespace microtrace::io::gltf {
namespace {

constexpr double aspect_ratio = 4.0 / 3;
constexpr double filled = 0.9;

struct Frame {
  DVec3 right, up, back;  // orthonormal
};

Frame view_frame() {
  const DVec3 back = DVec3(4, 4, 7) / 9.0;  // 4^2 + 4^2 + 7^2 = 9^2
  const DVec3 right = DVec3(7, 0, -4) / std::sqrt(65.0);
  return {.right = right, .up = glm::cross(back, right), .back = back};
}

template <typename Visit>
void for_each_vertex(const std::vector<Object>& objects, Visit&& visit) {
  for (const Object& object : objects) {
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) continue;
    for (const Vec3& p : mesh->positions) {
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) visit(DVec3(p));
    }
  }
}

struct Bounds {
  DVec3 low{std::numeric_limits<double>::infinity()};
  DVec3 high{-std::numeric_limits<double>::infinity()};

  void add(const DVec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

}  // namespace

PerspectiveCamera frame(const std::vector<Object>& objects) {
  const Frame view = view_frame();
  const double slope_y = filled * (std::sqrt(2.0) - 1);  // tan(45 degrees / 2)
  const double slope_x = slope_y * aspect_ratio;

  Bounds box;
  for_each_vertex(objects, [&box](const DVec3& p) { box.add(p); });
  const bool empty = !(box.low.x <= box.high.x);
  const DVec3 center = empty ? DVec3(0) : box.low * 0.5 + box.high * 0.5;
  const double diagonal = empty ? 0 : glm::length(box.high - box.low);

  // In the frame's axes, from the center: a camera at (x, y, z) sees a vertex v within the slope s
  // if |v.x - x| <= s (z - v.z). So x + s z is at least the greatest v.x + s v.z, and s z - x at
  // least the greatest s v.z - v.x. Both hold with the least z where both are equalities.
  DVec3 high(0), low(0);
  double nearest = 0;
  bool first = true;
  for_each_vertex(objects, [&](const DVec3& p) {
    const DVec3 d = p - center;
    const DVec3 v(glm::dot(d, view.right), glm::dot(d, view.up), glm::dot(d, view.back));
    const DVec3 plus(v.x + slope_x * v.z, v.y + slope_y * v.z, 0);
    const DVec3 minus(slope_x * v.z - v.x, slope_y * v.z - v.y, 0);
    high = first ? plus : glm::max(high, plus);
    low = first ? minus : glm::max(low, minus);
    nearest = first ? v.z : std::max(nearest, v.z);
    first = false;
  });
  const double distance =
      std::max({(high.x + low.x) / (2 * slope_x), (high.y + low.y) / (2 * slope_y),
                nearest + (diagonal > 0 ? diagonal / 64 : 1)});
  const DVec3 position = center + view.right * ((high.x - low.x) / 2) +
                         view.up * ((high.y - low.y) / 2) + view.back * distance;
  return {.pose = {.position = position, .direction = -view.back, .up = {0, 1, 0}},
          .vertical_fov = std::numbers::pi / 4,
          .aspect_ratio = aspect_ratio};
}

}  // namespace microtrace::io::gltf
