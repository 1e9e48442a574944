#include "accel/ray_stream.hpp"

#include "accel/hit_rounding.hpp"
#include "accel/kernel_rays.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "accel/resolve/open_side.hpp"

#include <algorithm>
#include <cassert>

namespace microtrace {

void RayStream::fill(const Rays& these) {
  const auto& [rays, left] = these;
  assert(rays.size() <= kStreamRays);
  rays_ = rays;
  KernelStream& s = stream_;
  s.count = static_cast<int>(rays.size());
  target_.kernels.read_stream(numbers_of(rays), s);
  if (left.empty())
    std::fill_n(s.omitted_id, rays.size(), kNoPrimitive);
  else
    std::ranges::copy(left, s.omitted_id);
  prepare();
}

void RayStream::fill(const RayColumns& rays) {
  assert(rays.count <= kStreamRays);
  rays_ = {};
  columns_ = rays;
  KernelStream& s = stream_;
  s.count = static_cast<int>(rays.count);
  // Sets the rest of the last vector too, because valgrind reports branches on numbers that were
  // never set, even if these branches change nothing.
  constexpr std::size_t kWidest = kGroupRays;
  const std::size_t end = (rays.count + kWidest - 1) / kWidest * kWidest;
  const auto set = [&](const auto* from, auto* to) {
    std::fill(std::copy_n(from, rays.count, to), to + end, std::decay_t<decltype(*to)>{});
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    set(rays.o[axis], s.o[axis]);
    set(rays.d[axis], s.d[axis]);
  }
  if (rays.t_min == nullptr)
    std::fill_n(s.t_min, end, 0.0F);
  else
    set(rays.t_min, s.t_min);
  set(rays.t_max, s.best_hi);
  set(rays.left, s.omitted_id);
  prepare();
}

void RayStream::prepare() {
  target_.kernels.prepare_stream(stream_);
  ask_unbounded();
}

void RayStream::ask_unbounded() {
  if (target_.unbounded.empty()) return;
  for (std::size_t i = 0; i < count(); ++i) {
    if (!is_suited(i)) continue;
    const Ray own = ray(i);
    const HitResolver resolver(target_.primitives, own);
    ClosestSoFar best = no_hit(own);
    for (const PrimitiveId id : target_.unbounded) consider(i, own, resolver, id, best);
    stream_.best_lo[i] = best.lo;
    stream_.best_hi[i] = best.hi;
    stream_.best_id[i] = best.id;
  }
}

void RayStream::consider(std::size_t i, PrimitiveId id, ClosestSoFar& best) const {
  if (!is_suited(i)) return;
  const Ray own = ray(i);
  consider(i, own, HitResolver(target_.primitives, own), id, best);
}

void RayStream::consider(std::size_t i, const Ray& own, const HitResolver& resolver, PrimitiveId id,
                         ClosestSoFar& best) const {
  if (meets_open_side(target_.primitives, target_.tree.open, own, id)) return;
  ClosestSoFar nearer = best;
  resolver.consider(id, nearer);
  if (nearer.id != id || !masked_.lets_pass(first_ + i, own, id)) {
    best = nearer;
    return;
  }
  // Duplicates aren't in the tree, but may be visible.
  std::optional<PrimitiveId> other = target_.duplicates.above(id, id);
  while (other && masked_.lets_pass(first_ + i, own, *other))
    other = target_.duplicates.above(id, *other);
  if (other) resolver.consider(*other, best);
}

Visible RayStream::visible(std::size_t i, PrimitiveId id, const HitWeights& at) const {
  Visible visible = masked_.known == nullptr ? Visible::unsure
                                             : masked_.known(masked_.context, first_ + i, id, at);
  if (visible == Visible::unsure && is_suited(i))
    visible = masked_.passes(masked_.context, first_ + i, ray(i), id) ? Visible::no : Visible::yes;
  if (visible != Visible::no || target_.duplicates.empty()) return visible;
  return target_.duplicates.above(id, id) ? Visible::unsure : Visible::no;
}

StreamFallback RayStream::fallback() {
  return {.context = this,
          .consider =
              [](void* self, int i, std::uint32_t id, ClosestSoFar& best) {
                static_cast<const RayStream*>(self)->consider(static_cast<std::size_t>(i), id,
                                                              best);
              },
          .visible =
              [](void* self, int i, std::uint32_t id, const HitWeights& at) {
                return static_cast<const RayStream*>(self)->visible(static_cast<std::size_t>(i), id,
                                                                    at);
              }};
}

void RayStream::find_closest(const Rays& these, std::span<std::optional<Hit>> hits) {
  fill(these);
  KernelStream& s = stream_;
  target_.kernels.closest_of_stream(target_.tree, s, fallback());
  for_each_unsuited([&](std::size_t i) { s.best_id[i] = kNoPrimitive; });
  for (std::size_t i = 0; i < rays_.size(); i += kHitBatch) {
    const std::size_t length = std::min<std::size_t>(kHitBatch, rays_.size() - i);
    const FoundHits found{.rays = rays_.subspan(i, length),
                          .ids = s.best_id + i,
                          .o = {s.o[0] + i, s.o[1] + i, s.o[2] + i},
                          .d = {s.d[0] + i, s.d[1] + i, s.d[2] + i}};
    round_hits(target_.primitives, target_.kernels, found, hits.subspan(i, length));
  }
}

void RayStream::find_closest(std::span<PrimitiveId> ids) {
  target_.kernels.closest_of_stream(target_.tree, stream_, fallback());
  std::copy_n(stream_.best_id, count(), ids.begin());
}

void RayStream::find_any(std::span<PrimitiveId> ids) {
  target_.kernels.any_of_stream(target_.tree, stream_, fallback());
  std::copy_n(stream_.best_id, count(), ids.begin());
}

void RayStream::find_any(std::span<bool> results) {
  target_.kernels.any_of_stream(target_.tree, stream_, fallback());
  for (std::size_t i = 0; i < count(); ++i) results[i] = stream_.best_id[i] != kNoPrimitive;
}

}  // namespace microtrace
