#include "queries/nearest_search.hpp"

#include "accel/filters/shape_filter.hpp"
#include "exact/range.hpp"
#include "queries/ray_search.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Relative errors of results that float64 may have.
constexpr double kDistanceError = 0x1p-40, kPositionError = 0x1p-42;

/// One for each lane of a node or a block.
using Distances = std::array<double, kWidth>;

double larger(double x, double y) {
  return x > y ? x : y;
}

/// The distances from p to the boxes of a node's children, squared. Roundings change them by less
/// than six units.
Distances squared_distances(const WideNode& node, const DVec3& p) {
  const float* const lo[3] = {node.lo_x, node.lo_y, node.lo_z};
  const float* const hi[3] = {node.hi_x, node.hi_y, node.hi_z};
  Distances sum{};
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kWidth; ++i) {
      const double gap = larger(larger(lo[axis][i] - p[axis], p[axis] - hi[axis][i]), 0);
      sum[i] += gap * gap;
    }
  }
  return sum;
}

/// The same for the bounding boxes of triangles. Unused lanes, which have NaN in a, may have any
/// result.
Distances squared_distances(const TriangleBlock& block, const DVec3& p) {
  const float* const a[3] = {block.a_x, block.a_y, block.a_z};
  const float* const b[3] = {block.b_x, block.b_y, block.b_z};
  const float* const c[3] = {block.c_x, block.c_y, block.c_z};
  Distances sum{};
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kWidth; ++i) {
      const float x = a[axis][i], y = b[axis][i], z = c[axis][i];
      const float above = x > y ? x : y, below = x < y ? x : y;
      const float hi = above > z ? above : z, lo = below < z ? below : z;
      const double gap = larger(larger(lo - p[axis], p[axis] - hi), 0);
      sum[i] += gap * gap;
    }
  }
  return sum;
}

bool suits_float64(const Triangle& triangle, const Vec3& p) {
  return is_filterable(p) && is_filterable(triangle);
}

const exact::Nearest& exact_nearest(auto& candidate, const Vec3& p) {
  if (!candidate.exactly) candidate.exactly = exact::nearest(candidate.triangle, p);
  return *candidate.exactly;
}

/// Bounds of the distance of exact::nearest.
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

/// Whether a candidate is nearer than the best so far, or as near with a lower id.
bool NearestSearch::precedes(Candidate& candidate, Candidate& best, const Vec3& p) const {
  if (candidate.distance.hi < best.distance.lo) return true;
  if (candidate.distance.lo > best.distance.hi) return false;
  if (share_feature(candidate.triangle, candidate.distance, best.triangle, best.distance))
    return candidate.id < best.id;
  const auto order = compare_distances(exact_nearest(candidate, p), exact_nearest(best, p));
  return order < 0 || (order == 0 && candidate.id < best.id);
}

void NearestSearch::consider(PrimitiveId id, const Triangle& triangle, const Vec3& p) {
  const auto selected = selection_.least(tree_.duplicates, id);
  if (!selected || (best_ && best_->id == *selected)) return;
  Candidate candidate{.id = *selected, .triangle = triangle};
  if (suits_float64(triangle, p))
    candidate.distance = triangle_distance(triangle, p);
  else
    candidate.distance = distance_of(exact_nearest(candidate, p));
  if (best_ && !precedes(candidate, *best_, p)) return;
  best_ = candidate;
  const double hi = best_->distance.hi;
  limit_ = hi * hi * (1 + 0x1p-48);
}

void NearestSearch::search_tree(const Vec3& p, Poll& poll) {
  struct Subtree {
    double squared_distance;
    ChildRef child;
  };
  std::array<Subtree, kMaxDepth*(kWidth - 1) + kWidth> stack;
  std::size_t size = 0;
  stack[size++] = {0, tree_.root};
  const DVec3 point(p);
  while (size > 0) {
    const auto [squared_distance, next] = stack[--size];
    if (squared_distance > limit_) continue;
    if ((next & child_ref::kKind) == 0) {
      const WideNode& node = tree_.nodes[next];
      const Distances distances = squared_distances(node, point);
      const std::size_t first = size;
      for (std::size_t i = 0; i < kWidth; ++i) {
        if (distances[i] > limit_ || !(node.lo_x[i] <= node.hi_x[i])) continue;
        // The nearest is on top.
        std::size_t k = size++;
        for (; k > first && stack[k - 1].squared_distance < distances[i]; --k)
          stack[k] = stack[k - 1];
        stack[k] = {distances[i], node.child[i]};
      }
      continue;
    }
    poll();
    const std::uint32_t begin = (next & ~child_ref::kKind) >> 3U, end = begin + (next & 7U) + 1;
    const bool are_triangles = (next & child_ref::kKind) == child_ref::kTriangles;
    for (std::uint32_t k = begin; k < end; ++k) {
      if (!are_triangles) {
        const PrimitiveId id = tree_.others[k];
        if (const auto triangle = primitives_.triangle(id)) consider(id, *triangle, p);
        continue;
      }
      const TriangleBlock& block = tree_.blocks[k];
      const Distances distances = squared_distances(block, point);
      for (std::size_t i = 0; i < kWidth; ++i) {
        const bool is_used = block.a_x[i] == block.a_x[i];
        if (is_used && !(distances[i] > limit_)) consider(block.id[i], triangle_in(block, i), p);
      }
    }
  }
}

std::optional<NearestPoint> NearestSearch::nearest(const Vec3& p, Poll& poll) {
  if (!exact::is_finite(p)) return std::nullopt;
  best_.reset();
  limit_ = std::numeric_limits<double>::infinity();
  for (const PrimitiveId id : tree_.unbounded) {
    poll();
    if (const auto triangle = primitives_.triangle(id)) consider(id, *triangle, p);
  }
  if (!tree_.blocks.empty() || !tree_.others.empty()) search_tree(p, poll);
  if (!best_) return std::nullopt;

  // From the scene's own triangle, so that the result does not depend on the tree.
  const Triangle triangle = *primitives_.triangle(best_->id);
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
