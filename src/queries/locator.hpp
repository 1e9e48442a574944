#pragma once
/// Finds the location of a point relative to closed surfaces by the parity of a ray's crossings.

#include "queries/runs.hpp"
#include "queries/selection.hpp"
#include "queries/tree_target.hpp"

#include <microtrace/queries.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace microtrace {

/// Returns the direction of the ray from p for an attempt to decide the location of p. The first
/// attempt has number 0.
[[nodiscard]] Vec3 crossing_direction(const Bounds& bounds, const Vec3& p, std::uint64_t attempt);

class Locator {
 public:
  Locator(const TreeTarget& target, Selection selection) : target_(target), selection_(selection) {}

  /// Returns the location of p, which is in scene coordinates.
  [[nodiscard]] Location locate(const Vec3& p, Poll& poll);

 private:
  /// Returns nothing if the ray in this direction can't decide, because it meets an edge or a
  /// vertex.
  [[nodiscard]] std::optional<Location> locate_along(const Vec3& p, const Vec3& d, Poll& poll);

  TreeTarget target_;
  Selection selection_;
  std::vector<PrimitiveId> crossed_;  // triangles of the tree that the ray crosses
};

}  // namespace microtrace
