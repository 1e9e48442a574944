#pragma once
/// Canonical Huffman codes of BasisLZ (KTX File Format Specification 2.0, appendix "BasisLZ/ETC1S
/// Bitstream Specification", section "Compressed Huffman Tables"). Codes are assigned as in RFC
/// 1951, section 3.2.2.

#include "modules/codecs/basis/bit_reader.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace basis {

class HuffmanTable {
 public:
  /// `lengths` has the code length of each symbol, 0 for symbols without a code. Throws Damage
  /// unless the code is complete or has at most one symbol.
  explicit HuffmanTable(std::span<const std::uint8_t> lengths);

  /// Reads the next symbol. Throws Damage.
  std::uint32_t decode(BitReader& bits) const {
    const Entry entry = entries_[bits.peek(longest_)];
    if (entry.length == 0) throw Damage("a Huffman code is invalid");
    bits.skip(entry.length);
    return entry.symbol;
  }

 private:
  struct Entry {
    std::uint16_t symbol = 0;
    std::uint8_t length = 0;
  };

  unsigned longest_ = 0;        // bits
  std::vector<Entry> entries_;  // indexed by the next longest_ bits
};

/// Reads a table from the file. Throws Damage.
[[nodiscard]] HuffmanTable read_huffman_table(BitReader& bits);

}  // namespace basis
