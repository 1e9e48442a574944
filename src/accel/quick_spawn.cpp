#include "accel/quick_spawn.hpp"

#include "accel/departure.hpp"
#include "accel/passing.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// As many as spawn_among takes before it looks further away.
constexpr int kSteps = 8;

Triangle triangle_at(const TreeView& tree, std::uint32_t place) {
  const TriangleBlock& block = tree.blocks[place / kWidth];
  const std::uint32_t i = place % kWidth;
  return {.a = {block.a_x[i], block.a_y[i], block.a_z[i]},
          .b = {block.b_x[i], block.b_y[i], block.b_z[i]},
          .c = {block.c_x[i], block.c_y[i], block.c_z[i]}};
}

SharedCoordinates shared_coordinates(const Vec3& point, const Vec3& normal) {
  SharedCoordinates result{.at = point};
  for (int k = 0; k < 3; ++k) {
    Vec3 others = normal;
    others[k] = 0;
    result.are_shared[static_cast<std::size_t>(k)] = others == Vec3(0);
  }
  return result;
}

bool is_filterable(const Ray& ray) {
  return microtrace::is_filterable(ray.o) && microtrace::is_filterable(ray.d);
}

}  // namespace

QuickSpawn::QuickSpawn(const Triangle& t, PrimitiveId id, const Ray& ray) : id_(id) {
  if (microtrace::is_filterable(t))
    set_flat({.a = t.a, .normal = normal_of(t)}, microtrace::shared_coordinates(t), ray);
}
QuickSpawn::QuickSpawn(const Plane& s, PrimitiveId id, const Ray& ray) : id_(id) {
  if (microtrace::is_filterable(s)) {
    set_flat({.a = s.point, .normal = CrossProduct(DVec3(s.normal))},
             shared_coordinates(s.point, s.normal), ray);
  }
}
QuickSpawn::QuickSpawn(const Disc& s, PrimitiveId id, const Ray& ray) : id_(id) {
  if (microtrace::is_filterable(s)) {
    set_flat({.a = s.center, .normal = CrossProduct(DVec3(s.normal))},
             shared_coordinates(s.center, s.normal), ray);
  }
}
QuickSpawn::QuickSpawn(const Quadric&, PrimitiveId id, const Ray&) : id_(id) {}

QuickSpawn::QuickSpawn(const Sphere& s, PrimitiveId id, const Ray& ray) : id_(id) {
  if (!microtrace::is_filterable(s) || !is_filterable(ray)) return;
  const DVec3 o(ray.o), d(ray.d);
  const Verdict t = SphereFilter(s, ray.o)(d, {.t_min = ray.t_min, .t_max = ray.t_max});
  if (t.certainty != Certainty::hit) return;
  p_ = rounded_point(ray, t, {});
  if (!p_) return;
  const double middle = (t.lo + t.hi) / 2;
  const DVec3 x = o + middle * d;
  surface_ = Ball{.sphere = s,
                  .from_center = x - DVec3(s.center),
                  .error = (t.hi - t.lo) * glm::abs(d) +
                           gamma(10) * (glm::abs(o) + glm::abs(middle * d) + glm::abs(x)) +
                           DVec3(kUnderflow)};
  double largest = 0, second = 0;
  for (int k = 0; k < 3; ++k) {
    const double unit = spacing((*p_)[k]);
    const double gain = std::abs(double{(*p_)[k]} - s.center[k]) * unit;
    reach_ = std::max(reach_, (kSteps + 1) * unit);
    second = std::max(second, std::min(gain, largest));
    if (gain > largest) axis_ = k, largest = gain;
  }
  // Else the choice of the axis is exact arithmetic's.
  if (!(largest > second * (1 + 0x1p-30))) p_.reset();
}

void QuickSpawn::set_flat(const Flat& flat, const SharedCoordinates& shared, const Ray& ray) {
  if (!is_filterable(ray)) return;
  const DVec3 from_a = DVec3(flat.a) - DVec3(ray.o);
  // As in TrianglePlaneFilter.
  const Approximate height{
      .value = glm::dot(from_a, flat.normal.value),
      .error = gamma(9) * glm::dot(glm::abs(from_a), flat.normal.permanent) + kUnderflow};
  const Verdict t = quotient_verdict(height, flat.normal.along(DVec3(ray.d)),
                                     {.t_min = ray.t_min, .t_max = ray.t_max});
  if (t.certainty == Certainty::unsure) return;
  p_ = rounded_point(ray, t, shared);
  if (!p_) return;
  surface_ = flat;
  double largest = 0, error = 0;
  for (int k = 0; k < 3; ++k) {
    const double unit = spacing((*p_)[k]), gain = std::abs(flat.normal.value[k]) * unit;
    reach_ = std::max(reach_, (kSteps + 1) * unit);
    error += gamma(5) * flat.normal.permanent[k] * unit;
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

bool QuickSpawn::is_passed_by(const Primitives& primitives, PrimitiveId id) const {
  return id == id_ || primitives.visit(id, [&](const auto& shape) {
    return microtrace::is_filterable(shape) && passes(shape, DVec3(*p_), reach_);
  });
}

bool QuickSpawn::is_alone(const Primitives& primitives, std::span<const PrimitiveId> outside,
                          const TreeView& tree, const PlaceQuery& found) const {
  if (found.count < 0) return false;
  const auto is_passed = [&](std::uint32_t place) {
    if (place >= kOtherPlace) return is_passed_by(primitives, tree.others[place - kOtherPlace]);
    return tree.blocks[place / kWidth].id[place % kWidth] == id_ ||
           passes(triangle_at(tree, place), DVec3(*p_), reach_);
  };
  return std::all_of(found.places, found.places + found.count, is_passed) &&
         std::all_of(outside.begin(), outside.end(),
                     [&](PrimitiveId id) { return is_passed_by(primitives, id); });
}

std::optional<Vec3> QuickSpawn::origin(const Vec3& direction) const {
  if (!microtrace::is_filterable(direction)) return std::nullopt;
  if (const auto* flat = std::get_if<Flat>(&surface_)) return origin(*flat, direction);
  if (const auto* ball = std::get_if<Ball>(&surface_)) return origin(*ball, direction);
  return std::nullopt;
}

std::optional<Vec3> QuickSpawn::origin(const Flat& flat, const Vec3& direction) const {
  const Approximate slope = flat.normal.along(DVec3(direction));
  if (!slope.is_positive() && !slope.is_negative()) return std::nullopt;
  const int side = slope.is_positive() ? 1 : -1;
  const bool up = (flat.normal.value[axis_] > 0) == (side > 0);
  Vec3 q = *p_;
  for (int step = 0; step <= kSteps; ++step) {
    const int sign = certain_side(flat.a, flat.normal, DVec3(q), DVec3(0));
    if (sign == side) return q;
    // No term but zeros: on the plane, as often on floors and walls.
    const DVec3 from_a = DVec3(q) - DVec3(flat.a);
    const bool is_on = glm::dot(glm::abs(from_a), flat.normal.permanent) == 0;
    if (sign == 0 && !is_on) return std::nullopt;
    q[axis_] = neighbour(q[axis_], up);
  }
  return std::nullopt;
}

std::optional<Vec3> QuickSpawn::origin(const Ball& ball, const Vec3& direction) const {
  const DVec3 w(direction), size = glm::abs(w);
  const Approximate slope{.value = glm::dot(ball.from_center, w),
                          .error = gamma(6) * glm::dot(glm::abs(ball.from_center), size) +
                                   glm::dot(ball.error, size) + kUnderflow};
  if (!slope.is_positive() && !slope.is_negative()) return std::nullopt;
  const int side = slope.is_positive() ? 1 : -1;
  const DVec3 center(ball.sphere.center);
  const bool up = ((*p_)[axis_] > center[axis_]) == (side > 0);
  Vec3 q = *p_;
  for (int step = 0; step <= kSteps; ++step) {
    const Approximate f = ball_value(ball.sphere.center, ball.sphere.radius, DVec3(q), 0);
    if (!f.is_positive() && !f.is_negative()) return std::nullopt;
    if (f.is_positive() == (side > 0)) {
      // From within there is one way out; from outside it must not lead back.
      if (side < 0 || dot_product(DVec3(q) - center, w, 4).is_positive()) return q;
      return std::nullopt;
    }
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
      quick[hits].emplace(shape, spawn.hit.id, *spawn.ray);
    });
    if (!quick[hits]->is_sure()) continue;
    quick[hits]->set_box(queries_[hits]);
    queries_[hits].count = 0;
    hit_of[done] = hits++;
  }
  if (tree_.nodes != nullptr) kernels_.touching(tree_, queries_.data(), static_cast<int>(hits));
  std::array<bool, kPlaceQueries> is_alone{};
  for (std::size_t k = 0; k < hits; ++k)
    is_alone[k] = quick[k]->is_alone(primitives_, outside_, tree_, queries_[k]);
  for (std::size_t i = 0; i < done; ++i) {
    const std::size_t k = hit_of[i];
    origins[i] = k != kNone && is_alone[k] ? quick[k]->origin(spawns[i].direction) : std::nullopt;
  }
  return done;
}

}  // namespace microtrace
