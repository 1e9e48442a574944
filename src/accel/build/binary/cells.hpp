#pragma once
/// Cells of neighboring references. The upper levels of the tree split sets of cells instead of
/// sets of references, which are far more. After P. Ganestam, R. Barringer, M. Doggett, T.
/// Akenine-Moller, Bonsai: rapid bounding volume hierarchy generation using mini trees, 2015.

#include "accel/build/references/references.hpp"
#include "accel/build/worker_pool.hpp"
#include "base/release.hpp"

#include <span>

namespace microtrace::build {

/// The references of a scene, divided into cells: those by which they are sorted, except that a
/// cell that is large compared with others is replaced by one for each of its references. Such a
/// cell contains a large primitive or a gap between primitives, and would enlarge the boxes of the
/// upper levels.
class Cells {
 public:
  /// Takes sorted references, of which the stored ones are in the order of the items.
  Cells(References references, WorkerPool& pool);

  /// One reference for each cell: its box, total weight, and its index instead of an id.
  [[nodiscard]] std::span<Reference> all() { return cells_; }

  /// Returns the number of references in several cells.
  [[nodiscard]] std::uint32_t size(std::span<const Reference> cells) const;

  /// Writes the references of several cells to `to` and releases their memory. Each cell can be
  /// taken once. Threads may call this at the same time for different cells.
  void take(std::span<const Reference> cells, Reference* to);

 private:
  // Replaces each large cell by one cell for each of its references.
  void dissolve_large();

  [[nodiscard]] std::uint32_t begin(const Reference& cell) const {
    return references_.cells[cell.id()];
  }
  [[nodiscard]] std::uint32_t end(const Reference& cell) const {
    return references_.cells[cell.id() + 1];
  }

  References references_;
  Release<CodedItem> used_items_{references_.items};
  Release<Reference> used_stored_{references_.stored};
  PageVector<Reference> cells_;
};

}  // namespace microtrace::build
