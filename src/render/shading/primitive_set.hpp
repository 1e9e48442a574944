#pragma once
#include "base/bit_set.hpp"

#include <microtrace/hit.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace microtrace {

/// A set of primitives, as in base/bit_set.hpp, that takes no memory while it is empty.
class PrimitiveSet {
 public:
  /// Constructs an empty set for primitives below `count`. `what` names them in the message if
  /// memory doesn't suffice. It must outlive the set.
  PrimitiveSet(PrimitiveId count, const char* what) : count_(count), what_(what) {}

  /// Inserts the primitives from `first` to `end` - 1. Throws Error (limit) if memory runs out.
  void insert(PrimitiveId first, PrimitiveId end);
  void clear();

  [[nodiscard]] BitPages pages() const { return pages_.empty() ? nullptr : pages_.data(); }

 private:
  void insert_into(std::size_t page, std::uint32_t first, std::uint32_t end);

  std::vector<BitPage*> pages_;
  std::vector<std::unique_ptr<BitPage>> mixed_;  // the pages that aren't shared with other sets
  PrimitiveId count_;
  const char* what_;
};

}  // namespace microtrace
