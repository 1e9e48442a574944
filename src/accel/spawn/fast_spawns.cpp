#include "accel/spawn/box_clearance.hpp"
#include "accel/spawn/fast_spawn.hpp"
#include "accel/spawn/origin_search.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace microtrace {
namespace {

Triangle triangle_at(const TreeView& tree, std::uint32_t slot) {
  const TriangleBlock& block = tree.blocks[slot / kWidth];
  const std::uint32_t i = slot % kWidth;
  return {.a = {block.a_x[i], block.a_y[i], block.a_z[i]},
          .b = {block.b_x[i], block.b_y[i], block.b_z[i]},
          .c = {block.c_x[i], block.c_y[i], block.c_z[i]}};
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

/// Sets the query to the box p +- reach; the rounding error is less than the reach.
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
  surface = {.id = spawn.hit.id, .is_triangle = false, .other = {}, .is_alone = false};
  if (exact::is_valid(*spawn.ray) && spawn.hit.id < primitives_.count()) {
    primitives_.visit(spawn.hit.id, [&]<class AnyShape>(const AnyShape& shape) {
      surface.is_triangle = std::is_same_v<AnyShape, Triangle>;
      if constexpr (std::is_same_v<AnyShape, Triangle>) {
        put(shape, *spawn.ray, hits_);
      } else {
        surface.other.emplace(shape, *spawn.ray);
      }
    });
  }
  ++hits_;
}

std::optional<AxisPlane> FastSpawns::axis_plane_of(std::size_t hit) const {
  if (!surfaces_[hit].is_triangle) return surfaces_[hit].other->axis_plane();
  return AxisPlane::of(vector_of(hit_points_.a, hit), vector_of(hit_points_.permanent, hit));
}

bool FastSpawns::is_alone(std::size_t hit, const Vec3& p, const DVec3& reach) const {
  const BoxQuery& found = queries_[hit];
  if (found.count < 0) return false;
  const PrimitiveId own = surfaces_[hit].id;
  const std::optional<AxisPlane> plane = axis_plane_of(hit);
  // Surfaces in the plane that the ray leaves don't obstruct it.
  const auto is_clear = [&](const auto& shape) {
    return (plane && lies_in(*plane, shape)) || clears_box(shape, DVec3(p), reach);
  };
  const auto is_primitive_passed = [&](PrimitiveId id) {
    return id == own || primitives_.visit(id, [&](const auto& shape) {
      return is_filterable(shape) && is_clear(shape);
    });
  };
  const auto is_passed = [&](std::uint32_t slot) {
    if (slot >= kOtherSlot) return is_primitive_passed(tree_->others[slot - kOtherSlot]);
    return tree_->blocks[slot / kWidth].id[slot % kWidth] == own ||
           is_clear(triangle_at(*tree_, slot));
  };
  return std::all_of(found.slots, found.slots + found.count, is_passed) &&
         std::all_of(outside_.begin(), outside_.end(), is_primitive_passed);
}

void FastSpawns::find_neighbors() {
  struct Point {
    bool is_sure;
    Vec3 p;
    DVec3 reach;
  };
  std::array<Point, kHits> points;
  for (std::size_t k = 0; k < hits_; ++k) {
    const LeftSurface& surface = surfaces_[k];
    BoxQuery& query = queries_[k];
    Point& point = points[k];
    query.count = 0;
    if (surface.is_triangle) {
      point = {.is_sure = hit_points_.is_sure[k] != 0,
               .p = vector_of(hit_points_.p, k),
               .reach = vector_of(hit_points_.reach, k)};
    } else {
      const bool is_sure = surface.other && surface.other->point();
      point = {.is_sure = is_sure,
               .p = is_sure ? *surface.other->point() : Vec3(0),
               .reach = is_sure ? surface.other->reach() : DVec3(0)};
    }
    point.is_sure ? set_box(point.p, point.reach, query) : set_empty(query);
  }
  if (tree_) kernels_.touching(*tree_, queries_.data(), static_cast<int>(hits_));
  for (std::size_t k = 0; k < hits_; ++k) {
    const auto& [is_sure, p, reach] = points[k];
    surfaces_[k].is_alone = is_sure && is_alone(k, p, reach);
  }
}

void FastSpawns::put(std::size_t hit, const Vec3& direction, std::size_t lane) {
  put_vector(origins_.a, lane, vector_of(hit_points_.a, hit));
  put_vector(origins_.p, lane, vector_of(hit_points_.p, hit));
  origins_.axis[lane] = hit_points_.axis[hit];
  for (std::size_t k = 0; k < 3; ++k) {
    origins_.n[k][lane] = hit_points_.n[k][hit];
    origins_.permanent[k][lane] = hit_points_.permanent[k][hit];
  }
  put_vector(origins_.direction, lane, direction);
}

void FastSpawns::leave_triangles(std::span<const Bvh::Spawn> spawns,
                                 std::span<std::optional<Vec3>> origins) {
  std::array<std::size_t, kSpawnLanes> spawn_of;
  std::size_t lanes = 0;
  const auto finish = [&] {
    if (lanes == 0) return;
    spawn_kernels_.find_origins(origins_);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (origins_.is_sure[lane] != 0) origins[spawn_of[lane]] = vector_of(origins_.origin, lane);
    }
    lanes = 0;
  };
  for (std::size_t i = 0; i < spawns.size(); ++i) {
    const LeftSurface& surface = surfaces_[hit_of_[i]];
    if (!surface.is_triangle || !surface.is_alone) continue;
    put(hit_of_[i], spawns[i].direction, lanes);
    spawn_of[lanes++] = i;
    if (lanes == kSpawnLanes) finish();
  }
  finish();
}

std::size_t FastSpawns::origins(std::span<const Bvh::Spawn> spawns,
                                std::span<std::optional<Vec3>> origins) {
  hits_ = 0;
  std::size_t done = 0;
  for (; done < spawns.size() && done < kSpawns; ++done) {
    const Bvh::Spawn& spawn = spawns[done];
    const bool is_same =
        done > 0 && spawns[done - 1].ray == spawn.ray && spawns[done - 1].hit.id == spawn.hit.id;
    if (!is_same) {
      if (hits_ == kHits) break;
      add(spawn);
    }
    hit_of_[done] = hits_ - 1;
  }
  const std::span<const LeftSurface> surfaces = std::span(surfaces_).first(hits_);
  if (std::ranges::any_of(surfaces, &LeftSurface::is_triangle))
    spawn_kernels_.find_hit_points(hit_points_);
  find_neighbors();
  for (std::size_t i = 0; i < done; ++i) {
    const LeftSurface& surface = surfaces_[hit_of_[i]];
    origins[i] = surface.other && surface.is_alone ? surface.other->origin(spawns[i].direction)
                                                   : std::nullopt;
  }
  leave_triangles(spawns.first(done), origins);
  return done;
}

}  // namespace microtrace
