#include "accel/spawn/spawn_among.hpp"

#include "accel/build/references/shape_box.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "accel/spawn/box_clearance.hpp"
#include "accel/spawn/origin_search.hpp"
#include "accel/spawn/touching.hpp"

#include <algorithm>
#include <unordered_set>
#include <vector>

#include <glm/common.hpp>

namespace microtrace {
namespace {

/// The other surfaces near a hit, and the required side of each, on which the new ray must start.
/// It is the side of the point w of Bvh::spawn_origin: just before the hit if the new ray goes
/// back, otherwise just behind the hit.
class Neighbors {
 public:
  /// p is the rounded hit point.
  Neighbors(const Primitives& primitives, const Ray& ray, PrimitiveId id, const Vec3& p,
            bool goes_back)
      : primitives_(primitives),
        ray_(ray),
        id_(id),
        p_(p),
        witness_(goes_back ? -ray.d : ray.d),
        point_(ray, KnownHit(primitives, ray, id, Duplicates()).bounds()) {}

  /// A box, also by its center and by its extent from there.
  struct Place {
    Bounds box;
    DVec3 center, radius;

    explicit Place(const Bounds& b) : box(b) {
      const DVec3 lo = b.lo, hi = b.hi;
      center = 0.5 * lo + 0.5 * hi;
      radius = glm::max(hi - center, center - lo) * (1 + 0x1p-20);
    }
  };

  /// Adds primitive `id` if it may have a point in the box.
  void add(PrimitiveId id, const Place& place) {
    if (id == id_ || known_.contains(id)) return;
    primitives_.visit(id, [&](const auto& shape) {
      if (build::is_empty(shape) || !is_near(shape, place)) return;
      known_.insert(id);
      if (const auto sign = side_of_witness(shape)) sides_.push_back({.id = id, .sign = *sign});
    });
  }

  /// Returns true if the segment from the hit to q meets none of the surfaces, because q is
  /// strictly on the required side or because the segment passes beside the surface. A surface that
  /// contains the ray has no required side.
  [[nodiscard]] bool allow(const Vec3& q) const {
    return std::all_of(sides_.begin(), sides_.end(), [&](const Side& side) {
      const int sign = primitives_.visit(side.id, [&](const auto& shape) {
        if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>)
          return TriangleSurface(shape).sign_at(q);
        else
          return exact::Implicit(shape).value(exact::vector(q)).sign();
      });
      if (sign != 0 && (side.sign == 0 || sign == side.sign)) return true;
      return primitives_.visit(side.id,
                               [&](const auto& shape) { return !may_be_between(shape, q); });
    });
  }

 private:
  struct Side {
    PrimitiveId id;
    int sign;
  };

  static bool is_near(const Triangle& t, const Place& place) {
    const Bounds own{.lo = glm::min(t.a, glm::min(t.b, t.c)),
                     .hi = glm::max(t.a, glm::max(t.b, t.c))};
    return overlap(own, place.box) &&
           TriangleSurface(t).certain_sign(place.center, place.radius) == 0;
  }
  template <class Other>
  static bool is_near(const Other& shape, const Place& place) {
    return !is_filterable(shape) || !clears_box(shape, place.center, place.radius);
  }

  // Returns true if the segment from the hit to q may meet a surface, given that the segment's ends
  // are not strictly on the same side of the surface.
  bool may_be_between(const Triangle& triangle, const Vec3& q) const {
    if (auto* hit = triangle_hit()) return hit->meets_segment(triangle, q);
    return exact::meets_segment(triangle, q, ray_, root());
  }
  // Tests the disc's own bounding box, so that the result doesn't depend on the tree.
  bool may_be_between(const Disc& disc, const Vec3& q) const {
    const build::Box box = build::box_of(disc);
    Bounds way{.lo = q, .hi = q};
    for (int k = 0; k < 3; ++k) {
      way.lo[k] = std::min(q[k], neighbor(p_[k], false));
      way.hi[k] = std::max(q[k], neighbor(p_[k], true));
    }
    return overlap(
        way, {.lo = {box.lo[0], box.lo[1], box.lo[2]}, .hi = {box.hi[0], box.hi[1], box.hi[2]}});
  }
  template <class Other>
  bool may_be_between(const Other&, const Vec3&) const {
    return true;
  }

  // Returns null if the surface that is hit is not a triangle.
  exact::TriangleHit* triangle_hit() const {
    if (!triangle_hit_ && !root_) {
      if (const auto t = primitives_.triangle(id_)) triangle_hit_.emplace(*t, ray_);
    }
    return triangle_hit_ ? &*triangle_hit_ : nullptr;
  }

  const exact::Root& root() const {
    if (!root_) root_ = ExactHits(primitives_, ray_).root(id_);
    return *root_;
  }

  // Returns the required side of a surface; nothing for triangles of zero area, which have no
  // sides.
  std::optional<int> side_of_witness(const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>) {
      const TriangleSurface surface(shape);
      if (const int sign = surface.certain_sign(point_.value, point_.error); sign != 0) return sign;
      if (!surface.has_area()) return std::nullopt;
      if (auto* hit = triangle_hit()) {
        const int side = hit->side(shape);
        return side != 0 ? side : surface.side(ray_, witness_);
      }
    }
    const exact::Implicit f(shape);
    const int sign = f.sign_at(ray_, root());
    return sign != 0 ? sign : f.sign_behind(ray_, root(), witness_);
  }

  const Primitives& primitives_;
  const Ray& ray_;
  PrimitiveId id_;
  Vec3 p_, witness_;
  PointOnRay point_;  // bounds of the exact hit point
  // Exact queries about the surface that is hit, created on first use.
  mutable std::optional<exact::TriangleHit> triangle_hit_;
  mutable std::optional<exact::Root> root_;
  std::unordered_set<PrimitiveId> known_;  // those near the hit
  std::vector<Side> sides_;
};

Bounds around(const Vec3& a, const Vec3& b, double margin) {
  Bounds box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = outwards(std::min(a[k], b[k]) - margin, 0, 0).lo;
    box.hi[k] = outwards(0, std::max(a[k], b[k]) + margin, 0).hi;
  }
  return box;
}

/// Tries the rounded hit point and its neighbors, then points farther along the line of `ray` and
/// their neighbors, on the side to which the new ray goes. These points are in the right cell of
/// the arrangement of all planes through the hit point.
template <class Surface>
std::optional<Vec3> search(Surface surface, const Primitives& primitives, const Tree* tree,
                           std::span<const PrimitiveId> unbounded, const Ray& ray, PrimitiveId id,
                           const Vec3& direction) {
  const std::optional<OriginSearch> start = origin_search(surface, ray, direction);
  if (!start) return std::nullopt;
  constexpr int kSteps = 8, kLevels = 6;
  const DVec3 along = start->goes_back ? -DVec3(ray.d) : DVec3(ray.d);
  const double length = std::max({std::abs(along.x), std::abs(along.y), std::abs(along.z)});
  const double unit = std::max({spacing(start->p.x), spacing(start->p.y), spacing(start->p.z)});
  Neighbors neighbors(primitives, ray, id, start->p, start->goes_back);

  double reach = 0;
  for (int level = 0; level < kLevels; ++level) {
    Vec3 q = unsigned_zeros(DVec3(start->p) + along * (reach / length));
    const Neighbors::Place place(around(start->p, q, 4 * kSteps * unit));
    const auto add = [&](PrimitiveId other) { neighbors.add(other, place); };
    std::for_each(unbounded.begin(), unbounded.end(), add);
    if (tree != nullptr) for_each_touching(*tree, place.box, add);
    for (int step = 0; step <= kSteps && is_finite(q); ++step) {
      if (surface.is_clear(q, direction, start->side) && neighbors.allow(q)) return q;
      start->step.apply(q);
    }
    reach = reach == 0 ? 4 * unit : 4 * reach;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Vec3> spawn_among(const Primitives& primitives, const Tree* tree,
                                std::span<const PrimitiveId> unbounded, const Ray& ray,
                                PrimitiveId id, const Vec3& direction) {
  return primitives.visit(id, [&](const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>)
      return search(TriangleSurface(shape), primitives, tree, unbounded, ray, id, direction);
    else
      return search(ExactSurface(shape), primitives, tree, unbounded, ray, id, direction);
  });
}

}  // namespace microtrace
