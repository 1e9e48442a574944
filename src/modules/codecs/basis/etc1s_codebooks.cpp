#include "modules/codecs/basis/etc1s.hpp"

namespace basis {
namespace {

constexpr const char* kDamaged = "the BasisLZ global data is damaged";

/// Returns the index of the Huffman table, out of three, for the difference from a channel's
/// previous value.
std::size_t delta_table(std::uint32_t previous) {
  if (previous <= 9) return 0;
  return previous <= 21 ? 1 : 2;
}

std::vector<Endpoint> read_endpoints(Bytes bytes, std::size_t count) {
  BitReader bits(bytes);
  std::array<HuffmanTable, 3> color_deltas = {read_huffman_table(bits), read_huffman_table(bits),
                                              read_huffman_table(bits)};
  const HuffmanTable intensity_deltas = read_huffman_table(bits);
  const std::size_t channels = bits.read(1) != 0 ? 1 : 3;  // 1 for gray
  std::vector<Endpoint> endpoints(count);
  Endpoint last{{16, 16, 16}, 0};
  for (Endpoint& endpoint : endpoints) {
    last.intensity = (last.intensity + intensity_deltas.decode(bits)) & 7U;
    for (std::size_t c = 0; c < channels; ++c) {
      const HuffmanTable& deltas = color_deltas[delta_table(last.color[c])];
      last.color[c] = (last.color[c] + deltas.decode(bits)) & 31U;
    }
    if (channels == 1) last.color[1] = last.color[2] = last.color[0];
    endpoint = last;
  }
  return endpoints;
}

std::vector<Selector> read_selectors(Bytes bytes, std::size_t count) {
  BitReader bits(bytes);
  if (bits.read(2) != 0) throw Damage(kDamaged);
  const bool is_raw = bits.read(1) != 0;
  const HuffmanTable deltas = is_raw ? HuffmanTable({}) : read_huffman_table(bits);
  std::vector<Selector> selectors(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t row = 0; row < 4; ++row) {
      const std::uint32_t value =
          is_raw || i == 0 ? bits.read(8) : deltas.decode(bits) ^ selectors[i - 1][row];
      selectors[i][row] = static_cast<std::uint8_t>(value);
    }
  }
  return selectors;
}

}  // namespace

Codebooks read_codebooks(const Ktx2& ktx2) {
  const Bytes global = ktx2.global;
  constexpr std::size_t kHeadSize = 20, kImageSize = 20;
  const std::size_t endpoint_count = number_at(global, 0, 2),
                    selector_count = number_at(global, 2, 2);
  const std::uint32_t endpoint_size = u32_at(global, 4), selector_size = u32_at(global, 8),
                      table_size = u32_at(global, 12);
  if (endpoint_count == 0 || selector_count == 0) throw Damage(kDamaged);

  constexpr std::uint32_t kIsPFrame = 2;
  const Bytes image = part_of(global, kHeadSize, kImageSize, kDamaged);
  if ((u32_at(image, 0) & kIsPFrame) != 0)
    throw Damage("is KTX2 of a video, whose frame depends on the one before");
  const auto slice = [&](std::size_t at) {
    return part_of(ktx2.level, u32_at(image, at), u32_at(image, at + 4), kDamaged);
  };

  const std::uint64_t endpoints_at = kHeadSize + std::uint64_t{ktx2.levels} * kImageSize,
                      selectors_at = endpoints_at + endpoint_size,
                      tables_at = selectors_at + selector_size;
  const Bytes endpoints = part_of(global, endpoints_at, endpoint_size, kDamaged);
  const Bytes selectors = part_of(global, selectors_at, selector_size, kDamaged);
  BitReader tables(part_of(global, tables_at, table_size, kDamaged));
  Codebooks books{.endpoints = read_endpoints(endpoints, endpoint_count),
                  .selectors = read_selectors(selectors, selector_count),
                  .predictions = read_huffman_table(tables),
                  .endpoint_deltas = read_huffman_table(tables),
                  .selector_symbols = read_huffman_table(tables),
                  .history_runs = read_huffman_table(tables),
                  .history_size = tables.read(13),
                  .color_slice = slice(4)};
  if (ktx2.channels != Channels::rgb) books.second_slice = slice(12);
  return books;
}

}  // namespace basis
