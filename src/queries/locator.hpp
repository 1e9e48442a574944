#pragma once
/// The location of a point relative to closed surfaces, by the parity of crossings.

#include "queries/runs.hpp"
#include "queries/selection.hpp"
#include "queries/tree_target.hpp"

#include <microtrace/queries.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace microtrace {

/// The direction of the ray that decides the location of p in an attempt, the first of which is 0.
[[nodiscard]] Vec3 crossing_direction(const Bounds& bounds, const Vec3& p, std::uint64_t attempt);

class Locator {
 public:
  Locator(const TreeTarget& target, Selection selection) : target_(target), selection_(selection) {}

  /// p is in scene coordinates.
  [[nodiscard]] Location locate(const Vec3& p, Poll& poll);

 private:
  /// Nothing if a ray in this direction can't decide.
  [[nodiscard]] std::optional<Location> locate_along(const Vec3& p, const Vec3& d, Poll& poll);

  TreeTarget target_;
  Selection selection_;
  std::vector<PrimitiveId> crossed_;  // triangles of the tree
};

}  // namespace microtrace
