#pragma once
/// Moves the references of a set to the two parts of a split.

#include "accel/build/binary/binning.hpp"
#include "accel/build/references/reference.hpp"
#include "accel/build/worker_pool.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace microtrace::build {

/// An array, divided for tasks of several threads. The division is the same for any number of
/// threads.
template <class T>
class Chunks {
 public:
  static constexpr std::size_t kSize = std::size_t{1} << 13U;

  explicit Chunks(std::span<T> all) : all_(all) {}
  [[nodiscard]] std::size_t size() const { return (all_.size() + kSize - 1) / kSize; }
  [[nodiscard]] std::span<T> operator[](std::size_t i) const {
    return all_.subspan(i * kSize, std::min(kSize, all_.size() - i * kSize));
  }

 private:
  std::span<T> all_;
};

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
