#include "accel/bvh_impl.hpp"
#include "accel/bvh_tree.hpp"
#include "accel/frustum/common_hit.hpp"
#include "accel/hit_rounding.hpp"
#include "accel/intersect_fronts.hpp"
#include "accel/kernel_rays.hpp"
#include "accel/kernels/dispatch.hpp"
#include "accel/ray_runs.hpp"
#include "accel/ray_stream.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "accel/resolve/open_side.hpp"
#include "accel/resolve/packet_resolver.hpp"
#include "accel/spawn/clear_point.hpp"
#include "accel/spawn/dispatch.hpp"
#include "accel/spawn/shape_spawn.hpp"
#include "accel/spawn/spawn_among.hpp"
#include "accel/stage_counts.hpp"
#include "base/system/float_environment.hpp"
#include "exact/first_hit.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

namespace microtrace {

Bvh::Impl::Impl(const Scene& scene, BvhOptions options)
    : primitives(scene),
      shared(make_bvh_tree(primitives, std::move(options))),
      kernels(&kRayKernels.best()),
      spawn_kernels(&kSpawnKernels.best()),
      instance_kernels(&kInstanceKernels.best()) {}

namespace {

// Tests every primitive, for rays beyond the kernels' limits.
std::optional<Hit> test_all(const Primitives& primitives, const Ray& ray) {
  if (!exact::is_valid(ray)) return std::nullopt;
  const HitResolver resolver(primitives, ray);
  const ExactHits exactly(primitives, ray);
  ClosestHitFinder closest;
  for (PrimitiveId id = 0; id < primitives.count(); ++id) {
    ++fallback_stages.filters;
    closest.consider(id, resolver.filtered(id), exactly);
  }
  return closest.rounded(exactly);
}

}  // namespace

std::optional<Hit> Bvh::Impl::intersect(const Ray& ray) const {
  const double t_scale = kernel_t_scale(ray);
  if (t_scale == 0) return test_all(primitives, ray);
  HitResolver resolver(primitives, ray, t_scale);
  ClosestSoFar best = resolver.no_hit();
  for (const PrimitiveId id : unbounded) resolver.consider(id, best);
  if (has_tree) kernels->closest(view(), kernel_ray(ray, t_scale), resolver.fallback(), best);
  if (best.id == kNoPrimitive) return std::nullopt;
  return resolver.hit(best.id);
}

std::optional<Hit> Bvh::Impl::next(const Ray& ray, PrimitiveId after) const {
  if (!exact::is_valid(ray) || after >= primitives.count()) return std::nullopt;
  const KnownHit known(primitives, ray, after, tree.duplicates);
  if (!known.exists()) return std::nullopt;
  const double t_scale = kernel_t_scale(ray);
  HitResolver resolver(primitives, ray, t_scale == 0 ? 1 : t_scale, &known);
  ClosestSoFar best = resolver.no_hit();
  if (t_scale == 0) {
    for (PrimitiveId id = 0; id < primitives.count(); ++id) resolver.consider(id, best);
  } else {
    for (const PrimitiveId id : unbounded) resolver.consider(id, best);
    if (has_tree) {
      const KernelRay from = kernel_ray_from(ray, t_scale, known.bounds());
      kernels->closest(view(), from, resolver.fallback(), best);
    }
  }
  if (best.id == kNoPrimitive) return std::nullopt;
  return resolver.hit(best.id);
}

std::optional<Vec3> Bvh::Impl::search_origin(const Spawn& spawn) const {
  ++fallback_stages.searched_origins;
  std::optional<Vec3> origin;
  if (exact::is_valid(*spawn.ray) && spawn.hit.id < primitives.count()) {
    origin = spawn_among(primitives, has_tree ? &tree : nullptr, unbounded, *spawn.ray,
                         spawn.hit.id, spawn.direction);
  }
  if (!origin) ++fallback_stages.missing_origins;
  return origin;
}

bool Bvh::Impl::occluded(const Ray& ray) const {
  const double t_scale = kernel_t_scale(ray);
  if (t_scale == 0) return test_all(primitives, ray).has_value();
  HitResolver resolver(primitives, ray, t_scale);
  ClosestSoFar best = resolver.no_hit();
  for (const PrimitiveId id : unbounded) {
    resolver.consider(id, best);
    if (best.id != kNoPrimitive) return true;
  }
  return has_tree && kernels->any(view(), kernel_ray(ray, t_scale), resolver.fallback());
}

bool Bvh::Impl::intersect_packet(std::span<const Ray> rays, const OpenSide& open,
                                 std::span<std::optional<Hit>> hits) const {
  KernelPacket packet;
  if (!fill_packet(rays, *kernels, packet)) return false;
  // The hits are written after the traversal.
  constexpr std::size_t kHitsOfLine = 64 / sizeof(std::optional<Hit>);
  for (std::size_t i = 0; i < rays.size(); i += kHitsOfLine) __builtin_prefetch(&hits[i], 1);
  PacketResolver resolver(primitives, *kernels, open, rays, packet);
  for (const PrimitiveId id : unbounded) resolver.consider_all(id, packet);
  if (has_tree) {
    TreeView from = view();
    from.open = open;
    kernels->closest_of_packet(from, packet, resolver.fallback());
  }
  round_hits(resolver, *kernels, packet, hits.first(rays.size()));
  return true;
}

void Bvh::Impl::intersect(std::span<const Ray> rays, std::span<const PrimitiveId> left,
                          const OpenSide& open, std::span<std::optional<Hit>> hits) const {
  assert(rays.size() == hits.size() && (left.empty() || left.size() == rays.size()));
  std::unique_ptr<RayStream> stream;
  while (!rays.empty()) {
    const auto whole = rays.first(std::min<std::size_t>(rays.size(), kPacketRays));
    std::size_t done = whole.size();
    // For few rays, the fixed cost of a packet is too high.
    bool is_packet = done >= kLeastPacket && whole.front().o == whole.back().o &&
                     intersect_packet(whole, open, hits);
    if (!is_packet) {
      done = common_origin_length(rays);
      is_packet = done >= kLeastPacket && done < whole.size() &&
                  intersect_packet(rays.first(done), open, hits);
    }
    if (!is_packet) {
      // Packets fail if one of their rays exceeds the limits. Streams ask such rays one by one.
      if (done < kLeastPacket) done = has_tree ? unrelated_length(rays) : 1;
      const auto ask_one = [&](std::size_t i) {
        hits[i] = intersect(rays[i], [&](PrimitiveId id) {
          return meets_open_side(primitives, open, rays[i], id);
        });
      };
      if (has_tree && done >= kLeastStream) {
        if (!stream) {
          stream = std::make_unique<RayStream>(stream_target());
          stream->set_filter({.open = open});
        }
        stream->closest({rays.first(done), left.first(left.empty() ? 0 : done)}, hits.first(done),
                        ask_one);
      } else {
        for (std::size_t i = 0; i < done; ++i) ask_one(i);
      }
    }
    rays = rays.subspan(done);
    hits = hits.subspan(done);
    if (!left.empty()) left = left.subspan(done);
  }
}

Bvh::Bvh(const Scene& scene, BvhOptions options)
    : impl_([&] {
        const FloatEnvironment environment;
        return std::make_unique<const Impl>(scene, std::move(options));
      }()) {}
Bvh::~Bvh() = default;
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;

CommonHit Bvh::common_hit(const Frustum& frustum) const {
  const FloatEnvironment environment;
  return microtrace::common_hit(impl_->primitives, impl_->tree, frustum);
}

const Primitives& Bvh::primitives() const {
  return impl_->primitives;
}

std::optional<Box> Bvh::bounds() const {
  if (!impl_->has_tree || !impl_->unbounded.empty()) return std::nullopt;
  return Box{.lo = impl_->tree.bounds.lo, .hi = impl_->tree.bounds.hi};
}

std::size_t Bvh::memory() const {
  const bool has_few = impl_->few != nullptr || impl_->large.triangles != nullptr;
  return memory_of(impl_->tree) + impl_->large.rest.size() * sizeof(WideNode) +
         (has_few ? sizeof(FewTriangles) : 0);
}

std::shared_ptr<const BvhTree> Bvh::tree() const {
  return impl_->shared;
}

std::optional<Hit> Bvh::intersect(const Ray& ray) const {
  const FloatEnvironment environment;
  return impl_->intersect(ray);
}

std::optional<Hit> Bvh::next(const Ray& ray, const Hit& after) const {
  const FloatEnvironment environment;
  return impl_->next(ray, after.id);
}

std::optional<Vec3> Bvh::spawn_origin(const Ray& ray, const Hit& hit, const Vec3& direction) const {
  const FloatEnvironment environment;
  ++fallback_stages.origins;
  const Hit represented{.id = impl_->tree.duplicates.representative(hit.id), .t = hit.t};
  return impl_->search_origin({.ray = &ray, .hit = represented, .direction = direction});
}

void Bvh::spawn_origins(std::span<const Spawn> spawns,
                        std::span<std::optional<Vec3>> origins) const {
  const FloatEnvironment environment;
  assert(spawns.size() == origins.size());
  fallback_stages.origins += spawns.size();
  std::vector<Spawn> represented;
  if (const Duplicates& duplicates = impl_->tree.duplicates; !duplicates.empty()) {
    // The tree holds only one triangle of each group of duplicates. If a ray left a different one,
    // the triangle in the tree would count as another surface.
    represented.assign(spawns.begin(), spawns.end());
    for (Spawn& spawn : represented) spawn.hit.id = duplicates.representative(spawn.hit.id);
    spawns = represented;
  }
  SpawnBatch quick = impl_->make_spawns();
  while (!spawns.empty()) {
    const std::size_t done = quick.origins(spawns, origins);
    for (std::size_t i = 0; i < done; ++i) {
      if (!origins[i]) origins[i] = impl_->search_origin(spawns[i]);
    }
    spawns = spawns.subspan(done);
    origins = origins.subspan(done);
  }
}

bool Bvh::is_clear(const Vec3& p) const {
  const FloatEnvironment environment;
  return is_clear_among(impl_->primitives, impl_->has_tree ? &impl_->tree : nullptr,
                        impl_->unbounded, p);
}

bool Bvh::occluded(const Ray& ray) const {
  const FloatEnvironment environment;
  return impl_->occluded(ray);
}

void Bvh::intersect(std::span<const Ray> rays, std::span<std::optional<Hit>> hits,
                    std::span<const PrimitiveId> left) const {
  const FloatEnvironment environment;
  impl_->intersect(rays, left, {}, hits);
}

void intersect_fronts(const Bvh& bvh, std::span<const Ray> rays, BitPages backs,
                      std::span<std::optional<Hit>> hits) {
  const FloatEnvironment environment;
  bvh.impl_->intersect(rays, {}, bvh.impl_->open_backs(backs), hits);
}

void Bvh::occluded(std::span<const Ray> rays, std::span<bool> results,
                   std::span<const PrimitiveId> left) const {
  const FloatEnvironment environment;
  assert(rays.size() == results.size() && (left.empty() || left.size() == rays.size()));
  const auto ask_one = [&](std::size_t i) { results[i] = impl_->occluded(rays[i]); };
  if (!impl_->has_tree || rays.size() < kLeastStream) {
    for (std::size_t i = 0; i < rays.size(); ++i) ask_one(i);
    return;
  }
  const auto stream = std::make_unique<RayStream>(impl_->stream_target());
  for (std::size_t first = 0; first < rays.size(); first += kStreamRays) {
    const std::size_t count = std::min<std::size_t>(kStreamRays, rays.size() - first);
    stream->any({rays.subspan(first, count), left.empty() ? left : left.subspan(first, count)},
                results.subspan(first, count), [&](std::size_t i) { ask_one(first + i); });
  }
}

}  // namespace microtrace
