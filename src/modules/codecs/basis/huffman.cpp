#include "modules/codecs/basis/huffman.hpp"

#include <algorithm>
#include <array>

namespace basis {
namespace {

constexpr unsigned kMaxLength = 16;

/// Reverses the bits of a code, because codes are stored highest bit first.
std::uint32_t reversed(std::uint32_t code, unsigned length) {
  std::uint32_t result = 0;
  for (unsigned i = 0; i < length; ++i) result |= (code >> i & 1U) << (length - 1 - i);
  return result;
}

/// The meaning of symbols 17 and above in the code for code lengths: a run of zeros or of the
/// previous length.
struct Run {
  unsigned least, bits;
  bool of_zeros;
};
constexpr std::array<Run, 4> kRuns = {{{3, 3, true}, {11, 7, true}, {3, 2, false}, {7, 7, false}}};
constexpr std::uint32_t kFirstRun = 17;

HuffmanTable read_length_table(BitReader& bits) {
  constexpr std::array<std::uint8_t, 21> kOrder = {17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                   11, 4,  12, 3,  13, 2, 14, 1, 15, 16};
  const std::uint32_t count = bits.read(5);
  if (count < 1 || count > kOrder.size()) throw Damage("a Huffman table is damaged");
  std::array<std::uint8_t, kOrder.size()> lengths{};
  for (std::uint32_t i = 0; i < count; ++i) {
    lengths[kOrder[i]] = static_cast<std::uint8_t>(bits.read(3));
  }
  return HuffmanTable(lengths);
}

}  // namespace

HuffmanTable::HuffmanTable(std::span<const std::uint8_t> lengths) {
  std::array<std::uint32_t, kMaxLength + 2> count{};
  for (const std::uint8_t length : lengths) ++count[length];
  const auto used = static_cast<std::uint32_t>(lengths.size()) - count[0];
  count[0] = 0;
  std::array<std::uint32_t, kMaxLength + 2> next{};  // next code of each length
  std::uint32_t space = 0;  // used part of the code space, which has the size 2^16
  for (unsigned length = 1; length <= kMaxLength; ++length) {
    next[length + 1] = (next[length] + count[length]) << 1U;
    space += count[length] << (kMaxLength - length);
    if (count[length] != 0) longest_ = length;
  }
  if (used > 1 && space != 1U << kMaxLength) throw Damage("a Huffman table is damaged");

  entries_.resize(std::size_t{1} << longest_);
  for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
    const std::uint8_t length = lengths[symbol];
    if (length == 0) continue;
    for (std::size_t i = reversed(next[length]++, length); i < entries_.size();
         i += std::size_t{1} << length) {
      entries_[i] = {static_cast<std::uint16_t>(symbol), length};
    }
  }
}

HuffmanTable read_huffman_table(BitReader& bits) {
  const std::uint32_t size = bits.read(14);
  if (size == 0) return HuffmanTable({});  // an empty table, for symbols that don't occur
  const HuffmanTable length_table = read_length_table(bits);
  std::vector<std::uint8_t> lengths;
  lengths.reserve(size);
  while (lengths.size() < size) {
    const std::uint32_t symbol = length_table.decode(bits);
    if (symbol < kFirstRun) {
      lengths.push_back(static_cast<std::uint8_t>(symbol));
      continue;
    }
    const Run& run = kRuns[symbol - kFirstRun];
    const std::uint8_t length = run.of_zeros || lengths.empty() ? 0 : lengths.back();
    if (!run.of_zeros && length == 0) throw Damage("a Huffman table is damaged");
    const std::size_t count = run.least + bits.read(run.bits);
    if (count > size - lengths.size()) throw Damage("a Huffman table is damaged");
    lengths.insert(lengths.end(), count, length);
  }
  return HuffmanTable(lengths);
}

}  // namespace basis
