#pragma once
/// Sets of a scene's primitives.

#include "base/bit_set.hpp"
#include "base/memory_account.hpp"

#include <microtrace/primitives.hpp>

#include <cstdint>
#include <vector>

namespace microtrace {

/// A set with one bit for each primitive, as in base/bit_set.hpp, that takes no memory while it is
/// empty.
class PrimitiveSet {
 public:
  /// `what` names the primitives in the message if memory doesn't suffice. It must outlive the set.
  PrimitiveSet(const Primitives& primitives, const char* what)
      : count_(primitives.count()), what_(what) {}

  /// Inserts the primitives from `first` to `end` - 1.
  void insert(PrimitiveId first, PrimitiveId end) {
    if (first == end) return;
    if (bits_.empty()) {
      take_memory(count_ / 8, what_);
      bits_.resize(bit_set_size(count_));
    }
    microtrace::insert(bits_.data(), first, end);
  }
  void clear() { bits_.clear(); }

  /// The bits, or null if the set is empty.
  [[nodiscard]] const std::uint32_t* bits() const { return bits_.empty() ? nullptr : bits_.data(); }

 private:
  std::vector<std::uint32_t> bits_;
  PrimitiveId count_;
  const char* what_;
};

}  // namespace microtrace
