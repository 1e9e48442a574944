#pragma once
/// The 19 modes of UASTC.

#include "modules/codecs/basis/bit_reader.hpp"

#include <cstddef>
#include <cstdint>

namespace basis {

/// ASTC's quantization of 8-bit numbers to `values` times 2^bits levels.
struct EndpointRange {
  unsigned values;  ///< 1, 3 (a trit) or 5 (a quint)
  unsigned bits;
};

enum class Channels { rgb, rgba, luminance_alpha };

struct UastcMode {
  unsigned code, code_length;  ///< prefix of a block, lowest bit first
  Channels channels;
  unsigned subsets;  ///< subsets of texels with their own endpoints; 0: one color for all texels
  unsigned planes;   ///< weights per texel
  unsigned weight_bits;  ///< bits per weight
  EndpointRange range;
  unsigned hint_bits;  ///< hints for conversion to other formats, ignored

  [[nodiscard]] std::size_t endpoint_values() const {
    switch (channels) {
      case Channels::rgb:
        return 6;
      case Channels::rgba:
        return 8;
      default:
        return 4;
    }
  }
};

/// The index of the mode that has its own patterns, mode 7.
inline constexpr std::size_t kUastcModeOfOtherPatterns = 7;

/// Reads the mode of a block. Throws Damage.
[[nodiscard]] std::size_t read_uastc_mode(BitReader& bits);
[[nodiscard]] const UastcMode& uastc_mode(std::size_t index);

}  // namespace basis
