#pragma once
/// Decodes ETC1S with BasisLZ (KTX File Format Specification 2.0, appendices "BasisLZ Global Data"
/// and "BasisLZ/ETC1S Bitstream Specification").

#include "modules/codecs/basis/huffman.hpp"
#include "modules/codecs/basis/ktx2.hpp"
#include "modules/codecs/basis/texels.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace basis {

/// A base color with 5 bits per channel, and the index of a row in ETC1's table of modifiers.
struct Endpoint {
  std::array<std::uint8_t, 3> color;
  std::uint8_t intensity;
};

/// Four 2-bit values for each row of a block. The leftmost value is in the lowest bits.
using Selector = std::array<std::uint8_t, 4>;

/// The codebooks of all levels, and the Huffman codes of references to them.
struct Codebooks {
  std::vector<Endpoint> endpoints;
  std::vector<Selector> selectors;
  HuffmanTable predictions, endpoint_deltas, selector_symbols, history_runs;
  std::uint32_t history_size = 0;
  /// Slices of the base level. The second one has alpha or green; it is empty if there is neither.
  Bytes color_slice{}, second_slice{};
};

/// Reads the codebooks. Throws Damage.
[[nodiscard]] Codebooks read_codebooks(const Ktx2& ktx2);

/// Decodes the color slice into the red, green and blue channels. Throws Damage.
void decode_color_slice(const Codebooks& books, const Texels& texels);
/// Decodes the second slice, which stores its numbers in its green channel, into this channel.
/// Throws Damage.
void decode_second_slice(const Codebooks& books, const Texels& texels, std::uint32_t channel);

}  // namespace basis
