#pragma once
/// Reads bits starting with the lowest bit of the first byte, as BasisLZ and UASTC store them.

#include "modules/codecs/basis/bytes.hpp"

#include <algorithm>

namespace basis {

class BitReader {
 public:
  explicit BitReader(Bytes bytes) : bytes_(bytes) {}

  /// Returns the next `count` bits, 0 to 32. The first bit becomes the lowest. Bits beyond the end
  /// of the data are zeros.
  [[nodiscard]] std::uint32_t peek(unsigned count) const {
    const std::size_t first = position_ / 8;
    const std::size_t end = std::min(bytes_.size(), first + 5);
    std::uint64_t window = 0;
    for (std::size_t i = first; i < end; ++i) {
      window |= std::uint64_t{bytes_[i]} << (8 * (i - first));
    }
    return static_cast<std::uint32_t>(window >> position_ % 8 & ((std::uint64_t{1} << count) - 1));
  }

  /// Advances by `count` bits. Throws Damage if this passes the end of the data.
  void skip(unsigned count) {
    position_ += count;
    if (position_ > 8 * bytes_.size()) throw Damage("the compressed data is cut off");
  }

  std::uint32_t read(unsigned count) {
    const std::uint32_t bits = peek(count);
    skip(count);
    return bits;
  }

 private:
  Bytes bytes_;
  std::size_t position_ = 0;  // bits
};

}  // namespace basis
