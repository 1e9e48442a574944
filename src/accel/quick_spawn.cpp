#include "accel/quick_spawn.hpp"

#include "accel/departure.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// More steps than a flat surface asks for (spawn.cpp).
constexpr int kSteps = 4;

Triangle triangle_at(const TreeView& tree, std::uint32_t place) {
  const TriangleBlock& block = tree.blocks[place / kWidth];
  const std::uint32_t i = place % kWidth;
  return {.a = {block.a_x[i], block.a_y[i], block.a_z[i]},
          .b = {block.b_x[i], block.b_y[i], block.b_z[i]},
          .c = {block.c_x[i], block.c_y[i], block.c_z[i]}};
}

CrossProduct normal_of(const Triangle& t) {
  return {DVec3(t.b) - DVec3(t.a), DVec3(t.c) - DVec3(t.a)};
}

/// Twice the area of a b p, seen along an axis.
Approximate area_along(int axis, const Vec3& a, const Vec3& b, const DVec3& p, double radius) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const DVec3 edge = DVec3(b) - DVec3(a), from_a = p - DVec3(a);
  const double left = edge[i] * from_a[j], right = edge[j] * from_a[i];
  // Each factor one rounding, the products one, the difference one.
  return {.value = left - right,
          .error = gamma(5) * (std::abs(left) + std::abs(right)) +
                   2 * radius * (std::abs(edge[i]) + std::abs(edge[j])) + kUnderflow};
}

/// Whether all of the box p +- radius lies beside the triangle, as seen along the axis nearest to
/// its normal: so it is where triangles share a plane.
bool is_beside(const Triangle& t, const CrossProduct& normal, const DVec3& p, double radius) {
  const DVec3 size = glm::abs(normal.value);
  const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  if (!(size[axis] > 2 * gamma(5) * normal.permanent[axis] + kUnderflow)) return false;
  const bool positive = normal.value[axis] > 0;
  const auto is_outside = [&](const Vec3& a, const Vec3& b) {
    const Approximate area = area_along(axis, a, b, p, radius);
    return positive ? area.is_negative() : area.is_positive();
  };
  return is_outside(t.a, t.b) || is_outside(t.b, t.c) || is_outside(t.c, t.a);
}

}  // namespace

QuickSpawn::QuickSpawn(const Triangle& triangle, PrimitiveId id, const Ray& ray)
    : a_(triangle.a), normal_(normal_of(triangle)), id_(id) {
  if (!is_filterable(ray.o) || !is_filterable(ray.d) || !is_filterable(triangle.a) ||
      !is_filterable(triangle.b) || !is_filterable(triangle.c))
    return;
  const DVec3 from_a = DVec3(triangle.a) - DVec3(ray.o);
  // As in TrianglePlaneFilter.
  const Approximate height{
      .value = glm::dot(from_a, normal_.value),
      .error = gamma(9) * glm::dot(glm::abs(from_a), normal_.permanent) + kUnderflow};
  const Verdict t = quotient_verdict(height, normal_.along(DVec3(ray.d)),
                                     {.t_min = ray.t_min, .t_max = ray.t_max});
  if (t.certainty == Certainty::unsure) return;
  p_ = rounded_point(triangle, ray, t);
  if (!p_) return;
  double largest = 0, error = 0;
  for (int k = 0; k < 3; ++k) {
    const double unit = spacing((*p_)[k]), gain = std::abs(normal_.value[k]) * unit;
    reach_ = std::max(reach_, (kSteps + 1) * unit);
    error += gamma(5) * normal_.permanent[k] * unit;
    if (gain > largest) axis_ = k, largest = gain;
  }
  // Else the choice of the axis is exact arithmetic's (TriangleSurface::gradient).
  if (!(error <= 0x1p-9 * largest)) p_.reset();
}

void QuickSpawn::set_box(PlaceQuery& query) const {
  for (int k = 0; k < 3; ++k) {
    // Rounded outwards by a part of the reach, which has room for it.
    query.lo[k] = static_cast<float>((*p_)[k] - 1.5 * reach_);
    query.hi[k] = static_cast<float>((*p_)[k] + 1.5 * reach_);
  }
}

bool QuickSpawn::is_alone(const TreeView& tree, const PlaceQuery& found) const {
  if (found.count < 0) return false;
  return std::all_of(found.places, found.places + found.count, [&](std::uint32_t place) {
    if (tree.blocks[place / kWidth].id[place % kWidth] == id_) return true;
    // The plane, or the triangle in it, passes by all points from the hit to the origin.
    const Triangle other = triangle_at(tree, place);
    const CrossProduct normal = normal_of(other);
    return certain_side(other.a, normal, DVec3(*p_), DVec3(reach_)) != 0 ||
           is_beside(other, normal, DVec3(*p_), reach_);
  });
}

std::optional<Vec3> QuickSpawn::origin(const Vec3& direction) const {
  if (!is_filterable(direction)) return std::nullopt;
  const Approximate slope = normal_.along(DVec3(direction));
  if (!slope.is_positive() && !slope.is_negative()) return std::nullopt;
  const int side = slope.is_positive() ? 1 : -1;
  const bool up = (normal_.value[axis_] > 0) == (side > 0);
  Vec3 q = *p_;
  for (int step = 0; step <= kSteps; ++step) {
    const int sign = certain_side(a_, normal_, DVec3(q), DVec3(0));
    if (sign == side) return q;
    // No term but zeros: on the plane, as often on floors and walls.
    const DVec3 from_a = DVec3(q) - DVec3(a_);
    const bool is_on = glm::dot(glm::abs(from_a), normal_.permanent) == 0;
    if (sign == 0 && !is_on) return std::nullopt;
    q[axis_] = neighbour(q[axis_], up);
  }
  return std::nullopt;
}

std::size_t QuickSpawns::origins(std::span<const Bvh::Spawn> spawns,
                                 std::span<std::optional<Vec3>> origins) {
  // One for each hit; which of them each spawn leaves, kNone if none.
  std::array<std::optional<QuickSpawn>, kPlaceQueries> quick;
  std::array<std::size_t, std::size_t{4} * kPlaceQueries> hit_of;
  constexpr std::size_t kNone = kPlaceQueries;
  std::size_t hits = 0, done = 0;
  for (; done < spawns.size() && done < hit_of.size(); ++done) {
    const Bvh::Spawn& spawn = spawns[done];
    const bool is_same =
        done > 0 && spawns[done - 1].ray == spawn.ray && spawns[done - 1].hit.id == spawn.hit.id;
    if (is_same) {
      hit_of[done] = hit_of[done - 1];
      continue;
    }
    if (hits == kPlaceQueries) break;
    hit_of[done] = kNone;
    if (!exact::is_valid(*spawn.ray) || spawn.hit.id >= primitives_.count()) continue;
    primitives_.visit(spawn.hit.id, [&](const auto& shape) {
      if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>)
        quick[hits].emplace(shape, spawn.hit.id, *spawn.ray);
    });
    if (!quick[hits] || !quick[hits]->is_sure()) continue;
    quick[hits]->set_box(queries_[hits]);
    hit_of[done] = hits++;
  }
  kernels_.touching(tree_, queries_.data(), static_cast<int>(hits));
  std::array<bool, kPlaceQueries> is_alone{};
  for (std::size_t k = 0; k < hits; ++k) is_alone[k] = quick[k]->is_alone(tree_, queries_[k]);
  for (std::size_t i = 0; i < done; ++i) {
    const std::size_t k = hit_of[i];
    origins[i] = k != kNone && is_alone[k] ? quick[k]->origin(spawns[i].direction) : std::nullopt;
  }
  return done;
}

}  // namespace microtrace
