#pragma once
/// Triangles that are the same set of points. One of them stands for all in the tree: where a mesh
/// lies a thousand times in one place a ray would meet a thousand triangles at one t otherwise, and
/// exact arithmetic would have to tell that they are no nearer than each other.

#include "accel/build/reference.hpp"

#include <microtrace/primitives.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace microtrace {

class Twins {
 public:
  Twins() = default;

  /// Takes triangles with the corners of another, in any order, out of the bounded references: of
  /// each such group the least number stays.
  Twins(build::References& references, const Primitives& primitives);

  /// The least number above `after` in the group that a primitive of the tree stands for.
  [[nodiscard]] std::optional<PrimitiveId> above(PrimitiveId id, PrimitiveId after) const;

  /// The primitive of the tree that stands for this one; itself unless it is a twin.
  [[nodiscard]] PrimitiveId representative(PrimitiveId id) const {
    return id < representatives_.size() ? representatives_[id] : id;
  }

  [[nodiscard]] bool empty() const { return ids_.empty(); }
  [[nodiscard]] std::size_t memory() const;  ///< bytes

  /// Those that are not in the tree.
  [[nodiscard]] const std::vector<PrimitiveId>& ids() const { return ids_; }

 private:
  struct Group {
    PrimitiveId least;
    std::size_t first, end;  // places in ids_, where they ascend
  };

  std::vector<PrimitiveId> ids_;              // by group
  std::vector<Group> groups_;                 // ascending
  std::vector<PrimitiveId> representatives_;  // of all primitives up to the last twin
};

}  // namespace microtrace
