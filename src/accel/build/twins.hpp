#pragma once
/// Triangles that are the same set of points. One of them stands for all in the tree: where a mesh
/// lies a thousand times in one place a ray would meet a thousand triangles at one t otherwise, and
/// exact arithmetic would have to tell that they are no nearer than each other.

#include "accel/build/page_allocator.hpp"
#include "accel/build/reference.hpp"

#include <microtrace/primitives.hpp>

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace microtrace {

class Twins {
 public:
  Twins() = default;

  /// Takes triangles with the corners of another, bit by bit, out of the references: of each such
  /// group the least number stays. Looks for them only where a sample shows that they are many.
  Twins(PageVector<build::Reference>& references, const Primitives& primitives);

  /// The least number above `after` in the group that a primitive of the tree stands for.
  [[nodiscard]] std::optional<PrimitiveId> above(PrimitiveId id, PrimitiveId after) const;

  /// Whether a primitive of the tree stands for that other one.
  [[nodiscard]] bool stands_for(PrimitiveId id, PrimitiveId other) const;

  /// Those that are not in the tree.
  [[nodiscard]] const std::vector<PrimitiveId>& ids() const { return ids_; }

 private:
  using Range = std::pair<std::size_t, std::size_t>;

  std::vector<PrimitiveId> ids_;                   // by group
  std::unordered_map<PrimitiveId, Range> groups_;  // places in ids_, where they ascend
};

}  // namespace microtrace
