#pragma once
/// Finds triangles that are the same set of points. Only one of them is in the tree. Otherwise a
/// ray through a mesh with a thousand coincident copies would hit a thousand triangles at the same
/// t, and exact arithmetic would have to decide every tie.

#include "accel/build/references/reference.hpp"

#include <microtrace/primitives.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace microtrace {

class Duplicates {
 public:
  Duplicates() = default;

  /// Removes triangles that have the same vertices as another, in any order, from the bounded
  /// references. The triangle with the least id of each group remains.
  Duplicates(build::References& references, const Primitives& primitives);

  /// The least id above `after` in the group that a primitive of the tree represents.
  [[nodiscard]] std::optional<PrimitiveId> above(PrimitiveId id, PrimitiveId after) const;

  /// The primitive of the tree that represents this one; the primitive itself unless it is a
  /// duplicate.
  [[nodiscard]] PrimitiveId representative(PrimitiveId id) const {
    return id < representatives_.size() ? representatives_[id] : id;
  }

  [[nodiscard]] bool empty() const { return ids_.empty(); }
  [[nodiscard]] std::size_t memory() const;  ///< bytes

  /// Whether the same primitives represent the same duplicates.
  [[nodiscard]] bool operator==(const Duplicates& other) const {
    return representatives_ == other.representatives_;
  }

  /// The primitives that are not in the tree.
  [[nodiscard]] const std::vector<PrimitiveId>& ids() const { return ids_; }

 private:
  struct Group {
    PrimitiveId least;
    std::size_t first, end;  // positions in ids_, where ids ascend
  };

  std::vector<PrimitiveId> ids_;              // in groups
  std::vector<Group> groups_;                 // ascending
  std::vector<PrimitiveId> representatives_;  // [id], for all primitives up to the last duplicate
};

}  // namespace microtrace
