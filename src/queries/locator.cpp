#include "queries/locator.hpp"

#include "accel/build/wide/wide_tree.hpp"
#include "accel/filters/shape_filter.hpp"
#include "base/split_mix.hpp"
#include "exact/crossing.hpp"
#include "exact/range.hpp"
#include "queries/ray_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

namespace microtrace {
/// The direction follows the axis of the shortest way out of the tree's bounds, where the ray
/// crosses the fewest triangles. It is turned slightly away from the axis, because many meshes have
/// edges parallel to the axes. Each attempt uses different random numbers.
Vec3 crossing_direction(const Bounds& bounds, const Vec3& p, std::uint64_t attempt) {
  int axis = 0;
  bool is_negative = false;
  float least = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    const float below = p[k] - bounds.lo[k], above = bounds.hi[k] - p[k];
    if (below < least) axis = k, is_negative = true, least = below;
    if (above < least) axis = k, is_negative = false, least = above;
  }
  Vec3 d{0};
  d[axis] = is_negative ? -1.0F : 1.0F;
  const std::uint64_t bits = split_mix(attempt + 1);
  // Returns an odd integer times 2^-28 with a random sign and a magnitude between 1/64 and 1/16.
  const auto turn = [](std::uint64_t from) {
    constexpr std::uint64_t kLow = (1U << 22U) - 1;
    const std::uint64_t odd = (1U << 22U) + 3 * (from & kLow);
    return static_cast<float>(odd | 1U) * (from >> 22U & 1U ? -0x1p-28F : 0x1p-28F);
  };
  d[(axis + 1) % 3] = turn(bits);
  d[(axis + 2) % 3] = turn(bits >> 32U);
  return d;
}

std::optional<Location> Locator::locate_along(const Vec3& p, const Vec3& d, Poll& poll) {
  crossed_.clear();
  bool is_on_boundary = false, is_grazing = false;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const bool filterable = is_filterable(p);
  const auto test = [&](PrimitiveId id, const Triangle& triangle) {
    if (is_on_boundary) return;
    if (filterable && is_filterable(triangle)) {
      // A certain hit is in the interior of the triangle and at t > 0.
      const FilterResult filtered =
          TriangleFilter(triangle, p)(DVec3(d), {.t_min = 0, .t_max = kInfinity});
      if (filtered.certainty == Certainty::miss) return;
      if (filtered.certainty == Certainty::hit) {
        crossed_.push_back(id);
        return;
      }
    }
    const exact::Crossing crossing = exact::crossing(triangle, p, d);
    if (crossing == exact::Crossing::none || !selection_.least(target_.tree.duplicates, id)) return;
    if (crossing == exact::Crossing::proper) crossed_.push_back(id);
    is_on_boundary = crossing == exact::Crossing::origin;
    is_grazing |= crossing == exact::Crossing::grazing;
  };
  const Ray ray{.o = p, .t_min = 0, .d = d};
  for_each_candidate(
      target_, ray,
      [&](const TriangleBlock& block, unsigned lanes) {
        poll();
        for (; lanes != 0; lanes &= lanes - 1) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
          test(block.id[lane], build::triangle_in(block, lane));
        }
      },
      [&](PrimitiveId id) {
        poll();
        if (const auto triangle = target_.primitives.triangle(id)) test(id, *triangle);
      });
  if (is_on_boundary) return Location::boundary;
  if (is_grazing) return std::nullopt;
  // A triangle with references in several leaves is found several times.
  std::ranges::sort(crossed_);
  crossed_.erase(std::unique(crossed_.begin(), crossed_.end()), crossed_.end());
  std::uint64_t count = 0;
  for (const PrimitiveId id : crossed_) count += selection_.count(target_.tree.duplicates, id);
  return count % 2 == 1 ? Location::inside : Location::outside;
}

Location Locator::locate(const Vec3& p, Poll& poll) {
  if (!is_finite(p)) return Location::outside;
  for (std::uint64_t attempt = 0;; ++attempt) {
    if (const auto location =
            locate_along(p, crossing_direction(target_.tree.bounds, p, attempt), poll))
      return *location;
  }
}

}  // namespace microtrace
