#include "queries/nearest_search.hpp"

#include "accel/filters/roundings.hpp"
#include "accel/filters/shape_filter.hpp"
#include "exact/range.hpp"
#include "queries/ray_search.hpp"
#include "simd/vectors.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Relative errors of results that float64 may have.
constexpr double kDistanceError = 0x1p-40, kPositionError = 0x1p-42;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One number for each lane of a node or a block.
using Distances = std::array<double, kWidth>;

/// The squared distances of the boxes of a node's children; infinity for unused slots. Roundings
/// change them by less than eight units.
Distances squared_distances(const WideNode& node, const DVec3& p) {
  Distances result;
  for (int i = 0; i < kWidth; i += 2) {
    Double<2> sum{};
    for (int axis = 0; axis < 3; ++axis) {
      // The arrays are consecutive.
      const auto below = widened<2>(node.lo_x + kWidth * axis + i) - p[axis];
      const auto above = p[axis] - widened<2>(node.hi_x + kWidth * axis + i);
      const auto gap = greater(greater(below, above), Double<2>{});
      sum += gap * gap;
    }
    for (int k = 0; k < 2; ++k) result[static_cast<std::size_t>(i + k)] = sum[k];
  }
  return result;
}

/// Lower bounds of the squared distances of a block's triangles, with roundings as above. Unused
/// lanes may have any result.
///
/// The larger of two bounds: the distance of the bounding box, which is good near the triangle; and
/// for G = A + B + C, with A, B, C from p to the vertices, the least of A.G / |G|, B.G / |G|, C.G /
/// |G|, which is good far away. A.G has three terms of at most 3 m^2, where m is the largest
/// |component| of A, B, C, with six roundings.
Distances squared_distances(const TriangleBlock& block, const DVec3& p) {
  const float *const a = block.a_x, *const b = block.b_x, *const c = block.c_x;
  Distances result;
  for (int i = 0; i < kWidth; i += 2) {
    using Pair = Double<2>;
    Pair sum{}, size{}, from_a{}, from_b{}, from_c{}, squared_g{};
    for (int axis = 0; axis < 3; ++axis) {
      const Pair x = widened<2>(a + kWidth * axis + i) - p[axis];
      const Pair y = widened<2>(b + kWidth * axis + i) - p[axis];
      const Pair z = widened<2>(c + kWidth * axis + i) - p[axis];
      const Pair least = lesser(x, lesser(y, z)), greatest = greater(x, greater(y, z));
      const Pair gap = greater(greater(least, -greatest), Pair{});
      sum += gap * gap;
      size = greater(size, greater(-least, greatest));
      const Pair g = x + y + z;
      from_a += x * g;
      from_b += y * g;
      from_c += z * g;
      squared_g += g * g;
    }
    const Pair from = lesser(from_a, lesser(from_b, from_c)) - 3 * 3 * 8 * kRoundoff * size * size;
    for (int k = 0; k < 2; ++k) {
      double& squared = result[static_cast<std::size_t>(i + k)];
      squared = sum[k];
      if (from[k] > 0) squared = std::max(squared, from[k] * from[k] / squared_g[k]);
    }
  }
  return result;
}

bool suits_float64(const Triangle& triangle, const Vec3& p) {
  return is_filterable(p) && is_filterable(triangle);
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
  const auto selected = selection_.least(tree_.duplicates, id);
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
        if (!(distances[i] <= limit_) || distances[i] == kInfinity) continue;
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
  exact_best_.reset();
  limit_ = kInfinity;
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
