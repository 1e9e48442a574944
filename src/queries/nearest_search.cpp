#include "queries/nearest_search.hpp"

#include "accel/build/wide/wide_tree.hpp"
#include "accel/filters/shape_filter.hpp"
#include "exact/range.hpp"
#include "queries/ray_search.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// The relative errors up to which results of float64 are accepted.
constexpr double kDistanceError = 0x1p-40, kPositionError = 0x1p-42;

constexpr double kInfinitelyFar = std::numeric_limits<double>::infinity();

/// The squared distance of each child of a node or each triangle of a block.
using Distances = std::array<double, kWidth>;

bool suits_float64(const Triangle& triangle, const Vec3& p) {
  return is_filterable(p) && is_filterable(triangle);
}

/// Returns bounds of a distance computed by exact::nearest.
TriangleDistance distance_of(const exact::Nearest& nearest) {
  const double distance = exact::distance(nearest);
  return {.lo = distance * (1 - kDistanceError),
          .hi = distance * (1 + kDistanceError),
          .weights = DVec3(0),
          .feature = Feature::face,
          .is_certain = false,
          .position_error = 0,
          .size = 0};
}

}  // namespace

bool NearestSearch::precedes(const Candidate& candidate, const Vec3& p) {
  if (share_feature(candidate.triangle, candidate.distance, best_->triangle, best_->distance))
    return candidate.id < best_->id;
  if (!exact_best_) exact_best_ = exact::nearest(best_->triangle, p);
  const exact::Nearest exactly = exact::nearest(candidate.triangle, p);
  const auto order = compare_distances(exactly, *exact_best_);
  return order < 0 || (order == 0 && candidate.id < best_->id);
}

void NearestSearch::consider(PrimitiveId id, const Triangle& triangle, const Vec3& p) {
  const TriangleDistance distance = suits_float64(triangle, p)
                                        ? triangle_distance(triangle, p)
                                        : distance_of(exact::nearest(triangle, p));
  if (best_ && distance.lo > best_->distance.hi) return;
  const auto selected = selection_.least(target_.tree.duplicates, id);
  if (!selected || (best_ && best_->id == *selected)) return;
  const Candidate candidate{.id = *selected, .triangle = triangle, .distance = distance};
  if (best_ && !(distance.hi < best_->distance.lo) && !precedes(candidate, p)) return;
  best_ = candidate;
  exact_best_.reset();
  limit_ = distance.hi * distance.hi * (1 + 0x1p-48);
}

void NearestSearch::search_tree(const Vec3& p, Poll& poll) {
  struct Subtree {
    double squared_distance;
    ChildRef child;
  };
  std::array<Subtree, kTraversalStack> stack;
  std::size_t size = 0;
  stack[size++] = {0, target_.tree.root};
  const DVec3 point(p);
  Distances distances;
  TreeReader reader(target_.tree);
  while (size > 0) {
    auto [squared_distance, next] = stack[--size];
    if (squared_distance > limit_ || reader.leave(next)) continue;
    if (reader.enter(next)) stack[size++] = {0, child_ref::kInstanceEnd};
    if (build::kind_of(next) == 0) {
      const WideNode& node = reader.node(next);
      target_.kernels.box_distances(node, &point.x, distances.data());
      const std::size_t first = size;
      for (std::size_t i = 0; i < kWidth; ++i) {
        if (!(distances[i] <= limit_) || distances[i] == kInfinitelyFar) continue;
        // Sorts the children, the nearest on top.
        std::size_t k = size++;
        for (; k > first && stack[k - 1].squared_distance < distances[i]; --k)
          stack[k] = stack[k - 1];
        stack[k] = {distances[i], node.child[i]};
      }
      continue;
    }
    poll();
    const auto [begin, end] = entries_of(next);
    const bool are_triangles = build::kind_of(next) == child_ref::kTriangles;
    for (std::uint32_t k = begin; k < end; ++k) {
      if (!are_triangles) {
        const PrimitiveId id = reader.other(k);
        if (const auto triangle = target_.primitives.triangle(id)) consider(id, *triangle, p);
        continue;
      }
      const TriangleBlock& block = reader.block(k);
      target_.kernels.triangle_distances(block, &point.x, distances.data());
      for (std::size_t i = 0; i < kWidth; ++i) {
        if (is_used(block, i) && !(distances[i] > limit_))
          consider(block.id[i], build::triangle_in(block, i), p);
      }
    }
  }
}

std::optional<NearestPoint> NearestSearch::nearest(const Vec3& p, Poll& poll) {
  if (!is_finite(p)) return std::nullopt;
  best_.reset();
  exact_best_.reset();
  limit_ = kInfinitelyFar;
  for (const PrimitiveId id : target_.tree.unbounded) {
    poll();
    if (const auto triangle = target_.primitives.triangle(id)) consider(id, *triangle, p);
  }
  if (target_.tree.has_leaves()) search_tree(p, poll);
  if (!best_) return std::nullopt;

  // Uses the scene's own triangle, because the order of vertices in a block differs.
  const Triangle triangle = *target_.primitives.triangle(best_->id);
  NearestPoint result{.id = best_->id};
  TriangleDistance distance{};
  if (suits_float64(triangle, p)) distance = triangle_distance(triangle, p);
  if (distance.is_certain && distance.position_error <= kPositionError * distance.size &&
      distance.hi - distance.lo <= kDistanceError * distance.lo) {
    result.distance = (distance.lo + distance.hi) / 2;
    result.barycentrics = distance.weights;
  } else {
    const exact::Nearest exactly = exact::nearest(triangle, p);
    result.distance = exact::distance(exactly);
    result.barycentrics = exact::barycentrics(exactly);
  }
  const DVec3& w = result.barycentrics;
  result.p = w.x * DVec3(triangle.a) + w.y * DVec3(triangle.b) + w.z * DVec3(triangle.c);
  return result;
}

}  // namespace microtrace
