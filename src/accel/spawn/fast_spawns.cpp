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

void FastSpawns::put(const Triangle& t, const Ray& ray, std::size_t lane) {
  put_vector(hit_points_.a, lane, t.a);
  put_vector(hit_points_.b, lane, t.b);
  put_vector(hit_points_.c, lane, t.c);
  put_vector(hit_points_.o, lane, ray.o);
  put_vector(hit_points_.d, lane, ray.d);
  hit_points_.t_min[lane] = ray.t_min;
  hit_points_.t_max[lane] = ray.t_max;
}

void FastSpawns::add(const Bvh::Spawn& spawn) {
  LeftSurface& surface = surfaces_[hits_];
  surface.id = spawn.hit.id;
  surface.is_triangle = false;
  surface.other.reset();
  if (spawn.hit.id < primitives_.count()) {
    primitives_.visit(spawn.hit.id, [&]<class AnyShape>(const AnyShape& shape) {
      surface.is_triangle = std::is_same_v<AnyShape, Triangle>;
      if constexpr (std::is_same_v<AnyShape, Triangle>) {
        put(shape, *spawn.ray, hits_);  // the kernel reports invalid rays as uncertain
      } else if (exact::is_valid(*spawn.ray)) {
        surface.other.emplace(shape, *spawn.ray);
      }
    });
  }
  ++hits_;
}

void FastSpawns::set_query(std::size_t hit) {
  LeftSurface& surface = surfaces_[hit];
  BoxQuery& query = queries_[hit];
  query.count = 0;
  query.omitted_id = surface.id;
  if (surface.is_triangle) {
    surface.is_known = hit_points_.is_sure[hit] != 0;
    for (int k = 0; k < 3; ++k) {
      query.lo[k] = hit_points_.lo[k][hit];
      query.hi[k] = hit_points_.hi[k][hit];
    }
    query.plane_axis = static_cast<int>(hit_points_.plane_axis[hit]);
    if (query.plane_axis >= 0) query.plane_at = hit_points_.a[query.plane_axis][hit];
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
  const DVec3 p(is_triangle ? vector_of(hit_points_.p, hit) : *surface.other->point());
  const DVec3 reach = is_triangle ? vector_of(hit_points_.reach, hit) : surface.other->reach();
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
  const auto is_passed = [&](std::uint32_t slot) {
    if (slot >= kOtherSlot) return is_primitive_passed(tree_->others[slot - kOtherSlot]);
    return clears_box(triangle_at(*tree_, slot), p, reach);
  };
  return std::all_of(found.slots, found.slots + found.count, is_passed) &&
         std::all_of(outside_.begin(), outside_.end(), is_primitive_passed);
}

void FastSpawns::find_neighbors() {
  for (std::size_t hit = 0; hit < hits_; ++hit) set_query(hit);
  if (tree_) kernels_.touching(*tree_, queries_.data(), static_cast<int>(hits_));
  for (std::size_t hit = 0; hit < hits_; ++hit) surfaces_[hit].is_alone = is_alone(hit);
}

void FastSpawns::leave_triangles(std::span<const Bvh::Spawn> spawns,
                                 std::span<std::optional<Vec3>> origins) {
  // Each pass computes the next origin for every triangle that still has one.
  for (std::size_t number = 0;; ++number) {
    std::uint32_t hits = 0;  // one bit per hit
    for (std::size_t hit = 0; hit < hits_; ++hit) {
      const std::size_t i = first_spawn_[hit] + number;
      if (i >= first_spawn_[hit + 1] || !surfaces_[hit].is_triangle || !surfaces_[hit].is_alone)
        continue;
      put_vector(origins_.direction, hit, spawns[i].direction);
      hits |= 1U << hit;
    }
    if (hits == 0) return;
    spawn_kernels_.find_origins(hit_points_, origins_);
    for (; hits != 0; hits &= hits - 1) {
      const auto hit = static_cast<std::size_t>(std::countr_zero(hits));
      if (origins_.is_sure[hit] != 0)
        origins[first_spawn_[hit] + number] = vector_of(origins_.origin, hit);
    }
  }
}

std::size_t FastSpawns::origins(std::span<const Bvh::Spawn> spawns,
                                std::span<std::optional<Vec3>> origins) {
  hits_ = 0;
  std::size_t done = 0;
  for (; done < spawns.size(); ++done) {
    const Bvh::Spawn& spawn = spawns[done];
    if (done > 0 && spawns[done - 1].ray == spawn.ray && spawns[done - 1].hit.id == spawn.hit.id)
      continue;
    if (hits_ == kHits) break;
    first_spawn_[hits_] = done;
    add(spawn);
  }
  first_spawn_[hits_] = done;
  const std::span<const LeftSurface> surfaces = std::span(surfaces_).first(hits_);
  if (std::ranges::any_of(surfaces, &LeftSurface::is_triangle))
    spawn_kernels_.find_hit_points(hit_points_);
  find_neighbors();
  for (std::size_t hit = 0; hit < hits_; ++hit) {
    const LeftSurface& surface = surfaces_[hit];
    for (std::size_t i = first_spawn_[hit]; i < first_spawn_[hit + 1]; ++i) {
      origins[i] = surface.other && surface.is_alone ? surface.other->origin(spawns[i].direction)
                                                     : std::nullopt;
    }
  }
  leave_triangles(spawns.first(done), origins);
  return done;
}

}  // namespace microtrace
