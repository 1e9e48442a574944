#include "accel/build/wide/wide_tree.hpp"
#include "accel/spawn/box_clearance.hpp"
#include "accel/spawn/origin_search.hpp"
#include "accel/spawn/shape_spawn.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

namespace microtrace {
namespace {

void put_vector(SpawnFloats (&lanes)[3], std::size_t lane, const Vec3& v) {
  for (int k = 0; k < 3; ++k) lanes[k][lane] = v[k];
}
Vec3 vector_of(const SpawnFloats (&lanes)[3], std::size_t lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}
DVec3 vector_of(const double (&lanes)[3][kSpawnLanes], std::size_t lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}

}  // namespace

Ray ray_of(const HitPointLanes& lanes, std::size_t lane) {
  return {.o = vector_of(lanes.o, lane),
          .t_min = lanes.t_min[lane],
          .d = vector_of(lanes.d, lane),
          .t_max = lanes.t_max[lane]};
}

void SpawnBatch::put(const Triangle& t, const Ray& ray, std::size_t lane) {
  put_vector(points_->a, lane, t.a);
  put_vector(points_->b, lane, t.b);
  put_vector(points_->c, lane, t.c);
  put_vector(points_->o, lane, ray.o);
  put_vector(points_->d, lane, ray.d);
  points_->t_min[lane] = ray.t_min;
  points_->t_max[lane] = ray.t_max;
}

void SpawnBatch::add(PrimitiveId id, const Ray& ray) {
  queries_.omitted_id[hits_] = id;
  std::optional<ShapeSpawn>& other = others_[hits_];
  other.reset();
  if (id < primitives_.count()) {
    primitives_.visit(id, [&]<class AnyShape>(const AnyShape& shape) {
      if constexpr (std::is_same_v<AnyShape, Triangle>) {
        put(shape, ray, hits_);  // the kernel reports invalid rays as uncertain
        triangles_ |= Lanes{1} << hits_;
      } else if (exact::is_valid(ray)) {
        other.emplace(shape, ray);
      }
    });
  }
  ++hits_;
}

void SpawnBatch::set_queries() {
  for (int k = 0; k < 3; ++k) {
    std::memcpy(queries_.lo[k], points_->lo[k], sizeof(SpawnFloats));
    std::memcpy(queries_.hi[k], points_->hi[k], sizeof(SpawnFloats));
  }
  std::memcpy(queries_.plane_axis, points_->plane_axis, sizeof(SpawnFloats));
  std::memcpy(queries_.plane_at, points_->plane_at, sizeof(SpawnFloats));
  for (std::size_t hit = 0; hit < kHits; ++hit)
    known_ |= Lanes{points_->is_sure[hit] != 0 ? 1U : 0U} << hit;
  known_ &= triangles_;
}

void SpawnBatch::set_query(std::size_t hit) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::optional<ShapeSpawn>& surface = others_[hit];
  queries_.plane_axis[hit] = -1;
  if (!surface || !surface->point()) {  // an empty box, which finds nothing
    for (int k = 0; k < 3; ++k) queries_.lo[k][hit] = kInfinity, queries_.hi[k][hit] = -kInfinity;
    return;
  }
  known_ |= Lanes{1} << hit;
  for (int k = 0; k < 3; ++k) {
    // The margin of another `reach` exceeds the rounding errors.
    const double p = (*surface->point())[k], margin = 2 * surface->reach()[k];
    queries_.lo[k][hit] = static_cast<float>(p - margin);
    queries_.hi[k][hit] = static_cast<float>(p + margin);
  }
  if (const std::optional<AxisPlane> plane = surface->axis_plane()) {
    queries_.plane_axis[hit] = static_cast<float>(plane->axis);
    queries_.plane_at[hit] = plane->at;
  }
}

SpawnBatch::Place SpawnBatch::place(std::size_t hit) const {
  if ((triangles_ >> hit & 1U) != 0)
    return {.p = DVec3(vector_of(points_->p, hit)), .reach = vector_of(points_->reach, hit)};
  return {.p = DVec3(*others_[hit]->point()), .reach = others_[hit]->reach()};
}

bool SpawnBatch::is_alone(std::size_t hit) const {
  const int count = queries_.count[hit];
  if (count < 0) return false;
  const Place at = place(hit);
  // Surfaces in the same plane as the surface that the ray leaves don't obstruct the ray. The query
  // already omits such triangles.
  const auto is_in_plane = [&](const auto& shape) {
    const int axis = static_cast<int>(queries_.plane_axis[hit]);
    return axis >= 0 && lies_in(AxisPlane{.axis = axis, .at = queries_.plane_at[hit]}, shape);
  };
  const auto is_primitive_passed = [&](PrimitiveId id) {
    return id == queries_.omitted_id[hit] || primitives_.visit(id, [&](const auto& shape) {
      return is_filterable(shape) && (is_in_plane(shape) || clears_box(shape, at.p, at.reach));
    });
  };
  const std::uint32_t* const slots = queries_.slots[hit];
  const auto is_passed = [&](const std::uint32_t& slot) {
    if (slot == kIdSlot) return is_primitive_passed(queries_.ids[hit][&slot - slots]);
    if (slot >= kOtherSlot) return is_primitive_passed(tree_->others[slot - kOtherSlot]);
    return clears_box(build::triangle_in(tree_->blocks[slot / kWidth], slot % kWidth), at.p,
                      at.reach);
  };
  return std::all_of(slots, slots + count, is_passed) &&
         std::all_of(unbounded_.begin(), unbounded_.end(), is_primitive_passed);
}

Lanes SpawnBatch::crowded() const {
  Lanes lanes = 0;
  for (std::size_t hit = 0; hit < kHits; ++hit)
    lanes |= Lanes{queries_.count[hit] != 0 ? 1U : 0U} << hit;
  return lanes;
}

void SpawnBatch::find_points() {
  known_ = 0;
  if (triangles_ != 0) {
    spawn_kernels_.find_hit_points(*points_);
    set_queries();
  }
  const Lanes all = (Lanes{1} << hits_) - 1;
  for (Lanes others = all & ~triangles_; others != 0; others &= others - 1)
    set_query(static_cast<std::size_t>(std::countr_zero(others)));
  queries_.size = static_cast<int>(hits_);
  if (tree_)
    kernels_.touching(*tree_, queries_);
  else
    std::ranges::fill(queries_.count, 0);
  alone_ = known_;
  for (Lanes rest = unbounded_.empty() ? known_ & crowded() : known_; rest != 0; rest &= rest - 1) {
    if (!is_alone(static_cast<std::size_t>(std::countr_zero(rest)))) alone_ &= ~(rest & -rest);
  }
}

void SpawnBatch::set_hits(std::span<const PrimitiveId> ids, Lanes on_meshes,
                          HitPointLanes& points) {
  points_ = &points;
  triangles_ = on_meshes;
  std::ranges::copy(ids, queries_.omitted_id);
  const Lanes all = (Lanes{1} << ids.size()) - 1;
  for (Lanes others = all & ~on_meshes; others != 0; others &= others - 1) {
    hits_ = static_cast<std::size_t>(std::countr_zero(others));
    add(ids[hits_], ray_of(points, hits_));
  }
  hits_ = ids.size();
  find_points();
}

Lanes SpawnBatch::leave(Lanes wanted, OriginLanes& lanes) const {
  const Lanes open = wanted & alone_;
  Lanes found = open & triangles_;
  if (found != 0) found = spawn_kernels_.find_origins(*points_, lanes, found);
  for (Lanes others = open & ~triangles_; others != 0; others &= others - 1) {
    const auto hit = static_cast<std::size_t>(std::countr_zero(others));
    if (const auto origin = others_[hit]->origin(vector_of(lanes.direction, hit))) {
      put_vector(lanes.origin, hit, *origin);
      found |= Lanes{1} << hit;
    }
  }
  return found;
}

std::size_t SpawnBatch::origins(std::span<const Bvh::Spawn> spawns,
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
