#include "accel/ray_stream.hpp"

#include "accel/hit_rounding.hpp"
#include "accel/slow_path.hpp"

#include <algorithm>

namespace microtrace {

RayStream::RayStream(const Target& target)
    : target_(target), rays_(std::make_unique_for_overwrite<Rays>()) {
  rays_->stream.count = 0;
}

void RayStream::add(const Ray& ray, std::size_t place) {
  KernelStream& s = rays_->stream;
  const auto i = static_cast<std::size_t>(s.count++);
  for (int axis = 0; axis < 3; ++axis) {
    s.o[axis][i] = ray.o[axis];
    s.d[axis][i] = ray.d[axis];
  }
  s.t_min[i] = ray.t_min;
  s.best_lo[i] = s.best_hi[i] = ray.t_max;
  s.best_id[i] = kNoPrimitive;
  rays_->rays[i] = ray;
  rays_->places[i] = place;
}

void RayStream::ask_outside() {
  if (target_.outside.empty()) return;
  KernelStream& s = rays_->stream;
  for (std::size_t i = 0; i < static_cast<std::size_t>(s.count); ++i) {
    const Judge judge(target_.primitives, rays_->rays[i]);
    Best best = no_hit(rays_->rays[i]);
    for (const PrimitiveId id : target_.outside) judge.consider(id, best);
    s.best_lo[i] = best.lo;
    s.best_hi[i] = best.hi;
    s.best_id[i] = best.id;
  }
}

StreamSlowPath RayStream::slow_path() {
  return {.context = this, .consider = [](void* self, int ray, std::uint32_t id, Best& best) {
            const RayStream& stream = *static_cast<const RayStream*>(self);
            const Ray& r = stream.rays_->rays[static_cast<std::size_t>(ray)];
            Judge(stream.target_.primitives, r).consider(id, best);
          }};
}

void RayStream::flush_closest(std::span<std::optional<Hit>> hits) {
  KernelStream& s = rays_->stream;
  const auto count = static_cast<std::size_t>(s.count);
  ask_outside();
  target_.kernels.closest_of_stream(target_.tree, s, slow_path());
  std::array<std::optional<Hit>, kHitBatch> rounded;
  for (std::size_t i = 0; i < count; i += kHitBatch) {
    const std::size_t length = std::min<std::size_t>(kHitBatch, count - i);
    const FoundHits found{.rays = std::span(rays_->rays).subspan(i, length),
                          .ids = s.best_id + i,
                          .o = {s.o[0] + i, s.o[1] + i, s.o[2] + i},
                          .d = {s.d[0] + i, s.d[1] + i, s.d[2] + i}};
    round_hits(target_.primitives, target_.kernels, found, rounded);
    for (std::size_t k = 0; k < length; ++k) hits[rays_->places[i + k]] = rounded[k];
  }
  s.count = 0;
}

void RayStream::flush_any(std::span<bool> results) {
  KernelStream& s = rays_->stream;
  const auto count = static_cast<std::size_t>(s.count);
  ask_outside();
  target_.kernels.any_of_stream(target_.tree, s, slow_path());
  for (std::size_t i = 0; i < count; ++i) results[rays_->places[i]] = s.best_id[i] != kNoPrimitive;
  s.count = 0;
}

}  // namespace microtrace
