#include "render/lights/light_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// From this depth on, lights are split into halves by count. This limits paths to 24 levels plus
/// 32 for 32-bit indices, so that they fit into the 64 bits of a trail.
constexpr unsigned kDeepest = 24;
constexpr int kBuckets = 12;

using Angle = LightAngle<1>;

Angle angle_of(float cosine) {
  return Angle::of(cosine, 1);
}

/// Returns the lesser of a + b and pi.
Angle sum(const Angle& a, const Angle& b) {
  const float sine = a.sine * b.cosine + a.cosine * b.sine;
  if (sine < 0 || a.cosine == -1 || b.cosine == -1) return {-1, 0};
  return {a.cosine * b.cosine - a.sine * b.sine, sine};
}

LightCone united(const LightCone& a, const LightCone& b) {
  LightCone cone{.axis = a.axis, .cos_o = -1, .cos_e = std::min(a.cos_e, b.cos_e)};
  const Vec3 middle = a.axis + b.axis;
  const float square = glm::dot(middle, middle);
  if (a.cos_o == -1 || b.cos_o == -1 || !(square > 1e-6F)) return cone;
  cone.axis = middle / std::sqrt(square);
  const Angle to_a = sum(angle_of(std::min(glm::dot(cone.axis, a.axis), 1.0F)), angle_of(a.cos_o));
  const Angle to_b = sum(angle_of(std::min(glm::dot(cone.axis, b.axis), 1.0F)), angle_of(b.cos_o));
  // Widens the cone slightly to compensate for rounding.
  cone.cos_o = std::max(std::min(to_a.cosine, to_b.cosine) - 1e-6F, -1.0F);
  return cone;
}

LightBounds united(const LightBounds& a, const LightBounds& b) {
  return {.low = glm::min(a.low, b.low),
          .high = glm::max(a.high, b.high),
          .power = a.power + b.power,
          .cone = united(a.cone, b.cone),
          .two_sided = a.two_sided || b.two_sided};
}

double half_area(const Vec3& low, const Vec3& high) {
  const DVec3 d = DVec3(high) - DVec3(low);
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

LightTreeSpace space_of(const LightBounds& bounds) {
  const DVec3 from(bounds.low), to(bounds.high), extent = to - from;
  const Vec3 origin((from + to) * 0.5);
  const double size = std::max({extent.x, extent.y, extent.z});
  const int exponent = size > 0 ? std::clamp(-std::ilogb(size), -126, 126) : 0;
  const double scale = std::ldexp(1.0, exponent);
  return {.origin = {origin.x, origin.y, origin.z},
          .scale = static_cast<float>(scale),
          .unit = bounds.power * scale * scale};
}

/// The node's radius includes the rounding errors of points in the units of the tree.
LightNode node_of(const LightBounds& bounds, const LightTreeSpace& space, double total_power) {
  const DVec3 from(bounds.low), to(bounds.high), diagonal = to - from;
  const DVec3 origin(space.origin[0], space.origin[1], space.origin[2]);
  const Vec3 center(((from + to) * 0.5 - origin) * double{space.scale});
  const double radius = std::sqrt(glm::dot(diagonal, diagonal)) * 0.5 * space.scale + 0x1p-22;
  const double power = std::max(bounds.power / total_power, double{LightTreeSpace::kLeast});
  const LightCone& cone = bounds.cone;
  return {.center = {center.x, center.y, center.z},
          .radius = static_cast<float>(radius),
          .power = static_cast<float>(power),
          .cos_o = cone.cos_o,
          .cone = {.axis = {cone.axis.x, cone.axis.y, cone.axis.z},
                   .sin_o = angle_of(cone.cos_o).sine,
                   .cos_e = cone.cos_e,
                   .is_two_sided = bounds.two_sided ? 1.0F : 0.0F}};
}

struct Bucket {
  LightBounds bounds;
  std::size_t count = 0;

  void add(const LightBounds& light) {
    bounds = count == 0 ? light : united(bounds, light);
    ++count;
  }
  void add(const Bucket& other) {
    if (other.count == 0) return;
    bounds = count == 0 ? other.bounds : united(bounds, other.bounds);
    count += other.count;
  }
  /// The power times the area of the box. The minimum area is for boxes that are flat or points.
  [[nodiscard]] double cost(double least_area) const {
    return bounds.power * (half_area(bounds.low, bounds.high) + least_area);
  }
};

}  // namespace

struct LightTree::Range {
  std::size_t begin, end;  ///< range of `order`
  std::size_t place;       ///< index of the node
  std::uint64_t trail = 0;
  unsigned depth = 0;
};

LightTree::LightTree(const std::vector<LightBounds>& lights) : trails_(lights.size()) {
  LightBounds all = lights[0];
  for (std::size_t i = 1; i < lights.size(); ++i) all = united(all, lights[i]);
  space_ = space_of(all);
  nodes_.reserve(2 * lights.size());
  nodes_.emplace_back();
  std::vector<std::uint32_t> order(lights.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  build(lights, order, {.begin = 0, .end = order.size(), .place = 0});
}

void LightTree::build(const std::vector<LightBounds>& lights, std::vector<std::uint32_t>& order,
                      const Range& range) {
  const auto [begin, end, place, trail, depth] = range;
  const double total_power = space_.unit / (double{space_.scale} * space_.scale);
  LightBounds bounds = lights[order[begin]];
  if (end - begin == 1) {
    nodes_[place] = node_of(bounds, space_, total_power);
    nodes_[place].light = order[begin];
    trails_[order[begin]] = trail;
    return;
  }
  const auto center = [&](std::uint32_t i) {
    return (DVec3(lights[i].low) + DVec3(lights[i].high)) * 0.5;
  };
  DVec3 low = center(order[begin]), high = low;
  for (std::size_t i = begin + 1; i < end; ++i) {
    bounds = united(bounds, lights[order[i]]);
    low = glm::min(low, center(order[i]));
    high = glm::max(high, center(order[i]));
  }
  nodes_[place] = node_of(bounds, space_, total_power);
  const DVec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;

  // Splits at the cheapest bucket boundary, or into halves if there is none or from kDeepest on.
  std::size_t middle = begin + (end - begin) / 2;
  if (extent[axis] > 0 && depth < kDeepest) {
    const double scale = kBuckets / extent[axis];
    const auto bucket_of = [&](std::uint32_t i) {
      return std::min(static_cast<int>((center(i)[axis] - low[axis]) * scale), kBuckets - 1);
    };
    std::array<Bucket, kBuckets> buckets;
    for (std::size_t i = begin; i < end; ++i)
      buckets[static_cast<std::size_t>(bucket_of(order[i]))].add(lights[order[i]]);
    const double least_area = extent[axis] * extent[axis] * 1e-4;
    int best = 0;
    double best_cost = std::numeric_limits<double>::infinity();
    for (int border = 1; border < kBuckets; ++border) {
      Bucket left, right;
      for (int b = 0; b < border; ++b) left.add(buckets[static_cast<std::size_t>(b)]);
      for (int b = border; b < kBuckets; ++b) right.add(buckets[static_cast<std::size_t>(b)]);
      if (left.count == 0 || right.count == 0) continue;
      const double cost = left.cost(least_area) + right.cost(least_area);
      if (cost < best_cost) best = border, best_cost = cost;
    }
    if (best > 0) {
      const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
      const auto last = order.begin() + static_cast<std::ptrdiff_t>(end);
      const auto border =
          std::stable_partition(first, last, [&](std::uint32_t i) { return bucket_of(i) < best; });
      middle = static_cast<std::size_t>(border - order.begin());
    }
  }
  const std::size_t children = nodes_.size();
  nodes_[place].children = static_cast<std::uint32_t>(children);
  nodes_.resize(children + 2);
  build(lights, order, {begin, middle, children, trail, depth + 1});
  build(lights, order, {middle, end, children + 1, trail | std::uint64_t{1} << depth, depth + 1});
}

float LightTree::probability(std::size_t light, const Vec3& p, const Vec3& n) const {
  constexpr int kLevels = 4;  // which are computed at a time, one in each lane
  const auto all_lanes = [](const Vec3& v) {
    return Floats3<kLevels>{all<kLevels>(v.x), all<kLevels>(v.y), all<kLevels>(v.z)};
  };
  const Floats3<kLevels> point = all_lanes(in_tree_units<1>(space_, p)), normal = all_lanes(n);
  std::uint64_t trail = trails_[light];
  float probability = 1;
  for (std::uint32_t next = nodes_[0].children; next != 0;) {
    std::uint32_t children[kLevels];
    bool is_second[kLevels];
    int count = 0;
    for (; count < kLevels && next != 0; trail >>= 1U) {
      children[count] = next;
      is_second[count++] = (trail & 1U) != 0;
      next = nodes_[next + (trail & 1U)].children;
    }
    for (int i = count; i < kLevels; ++i) children[i] = children[0];
    const Float<kLevels> first =
        LightChildren<kLevels>(nodes_.data(), children).first_probability(point, normal);
    for (int i = 0; i < count; ++i) {
      if (first[i] < 0) return 0;
      probability = child_probability<1>(probability, is_second[i] ? 1 - first[i] : first[i]);
      if (probability == 0) return 0;
    }
  }
  return probability;
}

}  // namespace microtrace
