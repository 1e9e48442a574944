#pragma once
/// Moves the references of a set to the two parts of a split.

#include "accel/build/binary/binning.hpp"
#include "accel/build/chunks.hpp"
#include "accel/build/references/reference.hpp"
#include "accel/build/worker_pool.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace microtrace::build {

/// The boxes of the centroids of both parts.
struct CentroidBoxes {
  Box left, right;

  void include(const CentroidBoxes& b) {
    left.include(b.left);
    right.include(b.right);
  }
};

/// Moves the references of the left part to the front, and keeps the order of each part. `scratch`
/// has room for the right part.
CentroidBoxes partition(std::span<Reference> set, const BinMapping& mapping, const Split& split,
                        Reference* scratch);

/// Does the same by all threads, but exchanges references that are in the wrong part. The order
/// depends only on the references and their order before. `scratch` has as many elements as the
/// set.
CentroidBoxes partition_together(std::span<Reference> set, const BinMapping& mapping,
                                 const Split& split, std::span<std::uint16_t> scratch,
                                 WorkerPool& pool);

}  // namespace microtrace::build
