#include "accel/spawn/box_clearance.hpp"
#include "accel/spawn/fast_spawn.hpp"
#include "accel/spawn/origin_search.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <type_traits>

namespace microtrace {
namespace {

Triangle triangle_at(const TreeView& tree, std::uint32_t slot) {
  const TriangleBlock& block = tree.blocks[slot / kWidth];
  const std::uint32_t i = slot % kWidth;
  return {.a = {block.a[0][i], block.a[1][i], block.a[2][i]},
          .b = {block.b[0][i], block.b[1][i], block.b[2][i]},
          .c = {block.c[0][i], block.c[1][i], block.c[2][i]}};
}

void put_vector(SpawnFloats (&lanes)[3], std::size_t lane, const Vec3& v) {
  for (int k = 0; k < 3; ++k) lanes[k][lane] = v[k];
}
Vec3 vector_of(const SpawnFloats (&lanes)[3], std::size_t lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}
DVec3 vector_of(const double (&lanes)[3][kSpawnLanes], std::size_t lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}

/// Sets the query to a box that contains p +- reach. The margin of another `reach` exceeds the
/// rounding errors.
void set_box(const Vec3& p, const DVec3& reach, BoxQuery& query) {
  for (int k = 0; k < 3; ++k) {
    query.lo[k] = static_cast<float>(p[k] - 2 * reach[k]);
    query.hi[k] = static_cast<float>(p[k] + 2 * reach[k]);
  }
}

/// Sets the query to an empty box, which finds nothing.
void set_empty(BoxQuery& query) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) query.lo[k] = kInfinity, query.hi[k] = -kInfinity;
}

}  // namespace

Ray ray_of(const HitPointLanes& lanes, std::size_t lane) {
  return {.o = vector_of(lanes.o, lane),
          .t_min = lanes.t_min[lane],
          .d = vector_of(lanes.d, lane),
          .t_max = lanes.t_max[lane]};
}

void FastSpawns::put(const Triangle& t, const Ray& ray, std::size_t lane) {
  put_vector(points_->a, lane, t.a);
  put_vector(points_->b, lane, t.b);
  put_vector(points_->c, lane, t.c);
  put_vector(points_->o, lane, ray.o);
  put_vector(points_->d, lane, ray.d);
  points_->t_min[lane] = ray.t_min;
  points_->t_max[lane] = ray.t_max;
}

void FastSpawns::add(PrimitiveId id, const Ray& ray) {
  LeftSurface& surface = surfaces_[hits_];
  surface.id = id;
  surface.is_triangle = false;
  surface.other.reset();
  if (id < primitives_.count()) {
    primitives_.visit(id, [&]<class AnyShape>(const AnyShape& shape) {
      surface.is_triangle = std::is_same_v<AnyShape, Triangle>;
      if constexpr (std::is_same_v<AnyShape, Triangle>) {
        put(shape, ray, hits_);  // the kernel reports invalid rays as uncertain
      } else if (exact::is_valid(ray)) {
        surface.other.emplace(shape, ray);
      }
    });
  }
  if (surface.is_triangle) triangles_ |= Lanes{1} << hits_;
  ++hits_;
}

void FastSpawns::set_query(std::size_t hit) {
  LeftSurface& surface = surfaces_[hit];
  BoxQuery& query = queries_[hit];
  query.count = 0;
  query.omitted_id = surface.id;
  if (surface.is_triangle) {
    surface.is_known = points_->is_sure[hit] != 0;
    for (int k = 0; k < 3; ++k) {
      query.lo[k] = points_->lo[k][hit];
      query.hi[k] = points_->hi[k][hit];
    }
    query.plane_axis = static_cast<int>(points_->plane_axis[hit]);
    if (query.plane_axis >= 0) query.plane_at = points_->a[query.plane_axis][hit];
    return;
  }
  surface.is_known = surface.other && surface.other->point();
  query.plane_axis = -1;
  if (!surface.is_known) return set_empty(query);
  set_box(*surface.other->point(), surface.other->reach(), query);
  if (const std::optional<AxisPlane> plane = surface.other->axis_plane()) {
    query.plane_axis = plane->axis;
    query.plane_at = plane->at;
  }
}

bool FastSpawns::is_alone(std::size_t hit) const {
  const LeftSurface& surface = surfaces_[hit];
  const BoxQuery& found = queries_[hit];
  if (!surface.is_known || found.count < 0) return false;
  if (found.count == 0 && outside_.empty()) return true;
  const bool is_triangle = surface.is_triangle;
  const DVec3 p(is_triangle ? vector_of(points_->p, hit) : *surface.other->point());
  const DVec3 reach = is_triangle ? vector_of(points_->reach, hit) : surface.other->reach();
  // Surfaces in the same plane as the surface that the ray leaves don't obstruct the ray. The query
  // already omits such triangles.
  const auto is_in_plane = [&](const auto& shape) {
    return found.plane_axis >= 0 &&
           lies_in(AxisPlane{.axis = found.plane_axis, .at = found.plane_at}, shape);
  };
  const auto is_primitive_passed = [&](PrimitiveId id) {
    return id == surface.id || primitives_.visit(id, [&](const auto& shape) {
      return is_filterable(shape) && (is_in_plane(shape) || clears_box(shape, p, reach));
    });
  };
  const auto is_passed = [&](const std::uint32_t& slot) {
    if (slot == kIdSlot) return is_primitive_passed(found.ids[&slot - found.slots]);
    if (slot >= kOtherSlot) return is_primitive_passed(tree_->others[slot - kOtherSlot]);
    return clears_box(triangle_at(*tree_, slot), p, reach);
  };
  return std::all_of(found.slots, found.slots + found.count, is_passed) &&
         std::all_of(outside_.begin(), outside_.end(), is_primitive_passed);
}

void FastSpawns::find_points() {
  if (triangles_ != 0) spawn_kernels_.find_hit_points(*points_);
  for (std::size_t hit = 0; hit < hits_; ++hit) set_query(hit);
  if (tree_) kernels_.touching(*tree_, queries_.data(), static_cast<int>(hits_));
  alone_ = 0;
  for (std::size_t hit = 0; hit < hits_; ++hit) {
    if (is_alone(hit)) alone_ |= Lanes{1} << hit;
  }
}

void FastSpawns::set_hits(std::span<const PrimitiveId> ids, Lanes on_meshes,
                          HitPointLanes& points) {
  points_ = &points;
  hits_ = 0;
  triangles_ = on_meshes;
  for (const PrimitiveId id : ids) {
    if ((on_meshes >> hits_ & 1U) == 0) {
      add(id, ray_of(points, hits_));
      continue;
    }
    surfaces_[hits_].id = id;
    surfaces_[hits_++].is_triangle = true;
  }
  find_points();
}

Lanes FastSpawns::leave(Lanes wanted, OriginLanes& lanes) const {
  const Lanes open = wanted & alone_;
  Lanes found = open & triangles_;
  if (found != 0) found &= spawn_kernels_.find_origins(*points_, lanes);
  for (Lanes others = open & ~triangles_; others != 0; others &= others - 1) {
    const auto hit = static_cast<std::size_t>(std::countr_zero(others));
    const auto& surface = surfaces_[hit].other;
    if (!surface) continue;
    if (const auto origin = surface->origin(vector_of(lanes.direction, hit))) {
      put_vector(lanes.origin, hit, *origin);
      found |= Lanes{1} << hit;
    }
  }
  return found;
}

std::size_t FastSpawns::origins(std::span<const Bvh::Spawn> spawns,
                                std::span<std::optional<Vec3>> origins) {
  points_ = &own_points_;
  hits_ = 0;
  triangles_ = 0;
  std::size_t done = 0;
  for (; done < spawns.size(); ++done) {
    const Bvh::Spawn& spawn = spawns[done];
    origins[done].reset();
    if (done > 0 && spawns[done - 1].ray == spawn.ray && spawns[done - 1].hit.id == spawn.hit.id)
      continue;
    if (hits_ == kHits) break;
    first_spawn_[hits_] = done;
    add(spawn.hit.id, *spawn.ray);
  }
  first_spawn_[hits_] = done;
  find_points();
  // Each pass computes the next origin for every hit that still has one.
  for (std::size_t number = 0;; ++number) {
    Lanes wanted = 0;
    for (std::size_t hit = 0; hit < hits_; ++hit) {
      const std::size_t i = first_spawn_[hit] + number;
      if (i >= first_spawn_[hit + 1]) continue;
      put_vector(origins_.direction, hit, spawns[i].direction);
      wanted |= Lanes{1} << hit;
    }
    if (wanted == 0) return done;
    for (Lanes found = leave(wanted, origins_); found != 0; found &= found - 1) {
      const auto hit = static_cast<std::size_t>(std::countr_zero(found));
      origins[first_spawn_[hit] + number] = vector_of(origins_.origin, hit);
    }
  }
}

}  // namespace microtrace
