#include "accel/build/wide/wide_tree.hpp"
#include "accel/bvh_tree.hpp"
#include "accel/filters/shape_filter.hpp"
#include "accel/resolve/exact_hits.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "base/system/float_environment.hpp"
#include "exact/first_hit.hpp"
#include "queries/duplicates.hpp"
#include "queries/kernels/dispatch.hpp"
#include "queries/ray_search.hpp"
#include "queries/runs.hpp"

#include <microtrace/queries.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <vector>

namespace microtrace {
namespace {

/// A primitive of the tree that the ray hits, and bounds of t at the hit. The primitive may have
/// duplicates.
struct BoundedHit {
  PrimitiveId id;
  double lo, hi;
};

/// Finds all hits of one ray at a time.
class HitFinder {
 public:
  HitFinder(const Bvh& bvh, const QueryKernels& kernels)
      : bvh_(bvh), shared_(bvh.tree()), kernels_(kernels) {}

  /// Rays are in scene coordinates.
  [[nodiscard]] std::uint32_t count(const Ray& ray, Poll& poll) {
    find(ray, poll);
    std::uint32_t count = 0;
    for (const BoundedHit& hit : found_)
      for_each_duplicate(tree_.duplicates, hit.id, [&](PrimitiveId) { ++count; });
    return count;
  }

  /// Appends the ray's hits in the order (t, PrimitiveId).
  void append(const Ray& ray, std::vector<Hit>& hits, Poll& poll) {
    find(ray, poll);
    const ExactHits exactly(primitives_, ray_);
    std::ranges::sort(found_, [&](const BoundedHit& a, const BoundedHit& b) {
      if (a.hi < b.lo) return true;
      if (b.hi < a.lo) return false;
      if (a.id == b.id) return false;
      poll();
      const auto order = exactly.order(a.id, b.id);
      return order < 0 || (order == 0 && a.id < b.id);
    });
    const auto rounded_t = [&](const BoundedHit& hit) {
      const auto t = exact::rounded({.lo = hit.lo, .hi = hit.hi});
      return t ? *t : exactly.t(hit.id);
    };
    if (tree_.duplicates.empty()) {
      for (const BoundedHit& hit : found_) hits.push_back({.id = hit.id, .t = rounded_t(hit)});
      return;
    }
    // Ids of duplicates may interleave with ids of other primitives at the same t.
    for (std::size_t i = 0; i < found_.size();) {
      const std::size_t first = hits.size();
      const float t = rounded_t(found_[i]);
      std::size_t end = i;
      do {
        for_each_duplicate(tree_.duplicates, found_[end].id,
                           [&](PrimitiveId id) { hits.push_back({.id = id, .t = t}); });
        ++end;
      } while (end < found_.size() && found_[end].lo <= found_[i].hi &&
               exactly.order(found_[end].id, found_[i].id) == 0);
      std::sort(hits.begin() + static_cast<std::ptrdiff_t>(first), hits.end(),
                [](const Hit& a, const Hit& b) { return a.id < b.id; });
      i = end;
    }
  }

 private:
  /// Finds the primitives of the tree that the ray hits.
  void find(const Ray& ray, Poll& poll) {
    poll();
    found_.clear();
    ray_ = ray;
    if (!exact::is_valid(ray_)) return;
    const ExactHits exactly(primitives_, ray_);
    const HitResolver resolver(primitives_, ray_);
    const Range range{.t_min = ray_.t_min, .t_max = ray_.t_max};
    const DVec3 d(ray_.d);
    const bool filterable = is_filterable(ray_.o) && is_filterable(ray_.d);
    const auto add = [&](PrimitiveId id, const FilterResult& filtered) {
      if (filtered.certainty == Certainty::hit) {
        found_.push_back({.id = id, .lo = filtered.lo, .hi = filtered.hi});
      } else if (filtered.certainty == Certainty::unsure) {
        if (const auto bounds = exactly.bounds(id))
          found_.push_back({.id = id, .lo = bounds->lo, .hi = bounds->hi});
      }
    };
    for_each_candidate(
        {.primitives = primitives_, .tree = tree_, .kernels = kernels_}, ray_,
        [&](const TriangleBlock& block, unsigned lanes) {
          poll();
          for (; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            FilterResult filtered{.certainty = Certainty::unsure};
            if (filterable) filtered = seen_from(ray_.o, build::triangle_in(block, lane))(d, range);
            add(block.id[lane], filtered);
          }
        },
        [&](PrimitiveId id) {
          poll();
          add(id, resolver.filtered(id));
        });
    // A triangle with references in several leaves is found several times.
    std::ranges::sort(found_, {}, &BoundedHit::id);
    const auto is_same = [](const BoundedHit& a, const BoundedHit& b) { return a.id == b.id; };
    found_.erase(std::unique(found_.begin(), found_.end(), is_same), found_.end());
  }

  const Bvh& bvh_;
  std::shared_ptr<const BvhTree> shared_;
  const QueryKernels& kernels_;
  const Tree& tree_ = shared_->tree;
  const Primitives& primitives_ = bvh_.primitives();
  Ray ray_;
  std::vector<BoundedHit> found_;
};

/// The number of rays that a thread takes at a time.
constexpr std::uint64_t kRaysOfRun = 64;

/// Calls ray(i) for the rays in scene coordinates.
template <class RayOf>
RayHits find_all(const Bvh& bvh, std::size_t rays, const RayOf& ray, const QueryOptions& options) {
  const FloatEnvironment environment;
  const QueryKernels& kernels = kQueryKernels.best();
  return limiting_memory([&] {
    RayHits result;
    std::vector<std::vector<Hit>> hits_of_run((rays + kRaysOfRun - 1) / kRaysOfRun);
    result.offsets.resize(rays + 1);
    for_each_run(rays, kRaysOfRun, options,
                 [&](std::uint64_t first, std::uint64_t last, Poll& poll) {
                   HitFinder finder(bvh, kernels);
                   std::vector<Hit>& hits = hits_of_run[first / kRaysOfRun];
                   for (std::uint64_t i = first; i < last; ++i) {
                     const std::size_t before = hits.size();
                     finder.append(ray(i), hits, poll);
                     result.offsets[i + 1] = hits.size() - before;
                   }
                 });
    for (std::size_t i = 0; i < rays; ++i) result.offsets[i + 1] += result.offsets[i];
    result.hits.reserve(result.offsets.back());
    for (std::vector<Hit>& hits : hits_of_run) {
      result.hits.insert(result.hits.end(), hits.begin(), hits.end());
      hits = {};
    }
    return result;
  });
}

/// Calls ray(i) for the rays in scene coordinates.
template <class RayOf>
void count_all(const Bvh& bvh, std::span<std::uint32_t> counts, const RayOf& ray,
               const QueryOptions& options) {
  const FloatEnvironment environment;
  const QueryKernels& kernels = kQueryKernels.best();
  limiting_memory([&] {
    for_each_run(counts.size(), kRaysOfRun, options,
                 [&](std::uint64_t first, std::uint64_t last, Poll& poll) {
                   HitFinder finder(bvh, kernels);
                   for (std::uint64_t i = first; i < last; ++i)
                     counts[i] = finder.count(ray(i), poll);
                 });
  });
}

}  // namespace

RayHits intersect_all(const PreparedScene& scene, std::span<const Ray> rays,
                      const QueryOptions& options) {
  return find_all(
      scene.bvh(), rays.size(), [&](std::uint64_t i) { return scene.in_scene(rays[i]); }, options);
}

RayHits intersect_all(const Bvh& bvh, std::span<const Ray> rays, const QueryOptions& options) {
  return find_all(
      bvh, rays.size(), [&](std::uint64_t i) { return rays[i]; }, options);
}

void count_crossings(const PreparedScene& scene, std::span<const Ray> rays,
                     std::span<std::uint32_t> counts, const QueryOptions& options) {
  assert(rays.size() == counts.size());
  count_all(
      scene.bvh(), counts, [&](std::uint64_t i) { return scene.in_scene(rays[i]); }, options);
}

void count_crossings(const Bvh& bvh, std::span<const Ray> rays, std::span<std::uint32_t> counts,
                     const QueryOptions& options) {
  assert(rays.size() == counts.size());
  count_all(
      bvh, counts, [&](std::uint64_t i) { return rays[i]; }, options);
}

}  // namespace microtrace
