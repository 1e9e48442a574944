#pragma once
/// Finds triangles that are the same set of points, so that only one of each group is stored in the
/// tree. Otherwise a ray through a thousand coincident copies of a mesh would hit a thousand
/// triangles at the same t, and exact arithmetic would have to decide every tie.

#include "accel/build/references/references.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace microtrace {

class Duplicates {
 public:
  Duplicates() = default;

  /// Groups triangles that have the same vertices in any order. Removes all but the one with the
  /// lowest id of each group from the items of the references, which must be sorted and of whole
  /// primitives.
  explicit Duplicates(build::References& references);

  /// Returns the lowest id above `after` in the group of primitive `id`, which must be in the tree.
  [[nodiscard]] std::optional<PrimitiveId> above(PrimitiveId id, PrimitiveId after) const;

  /// Returns the primitive in the tree that stands for this one. This is the primitive itself
  /// unless it was removed as a duplicate.
  [[nodiscard]] PrimitiveId representative(PrimitiveId id) const {
    return id < representatives_.size() ? representatives_[id] : id;
  }

  [[nodiscard]] bool empty() const { return ids_.empty(); }
  [[nodiscard]] std::size_t memory() const;  ///< in bytes

  /// True if the groups are the same.
  [[nodiscard]] bool operator==(const Duplicates& other) const {
    return representatives_ == other.representatives_;
  }

  /// Returns the primitives that were removed as duplicates.
  [[nodiscard]] const std::vector<PrimitiveId>& ids() const { return ids_; }

 private:
  struct Group {
    PrimitiveId least;
    std::size_t first, end;  // range of indices into ids_, where the group's removed ids ascend
  };
  struct Entry {
    std::uint64_t hash;  // of the set of vertices
    PrimitiveId id;
  };

  // Adds the group of the first entry, of several with the same hash and ascending ids.
  void add_group(std::span<const Entry> entries, const Primitives& primitives);

  std::vector<PrimitiveId> ids_;              // removed primitives, group by group
  std::vector<Group> groups_;                 // in ascending order of `least`
  std::vector<PrimitiveId> representatives_;  // by id, for all primitives up to the last duplicate
};

}  // namespace microtrace
