#pragma once
/// The 19 modes of UASTC.

#include "modules/codecs/basis/bit_reader.hpp"

#include <cstddef>
#include <cstdint>

namespace basis {

/// How ASTC quantizes a number of 8 bits: n values times 2^bits.
struct EndpointRange {
  unsigned values;  ///< 1, 3 (a trit) or 5 (a quint)
  unsigned bits;
};

enum class Channels { rgb, rgba, luminance_alpha };

struct UastcMode {
  unsigned code, code_length;  ///< begins a block, the lowest bit first
  Channels channels;
  unsigned subsets;      ///< of texels with endpoints of their own; 0: one color for all texels
  unsigned planes;       ///< weights of a texel
  unsigned weight_bits;  ///< each
  EndpointRange range;
  unsigned hint_bits;  ///< for conversion to other formats, passed over

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

/// Index of mode 7, whose patterns are its own.
inline constexpr std::size_t uastc_mode_of_other_patterns = 7;

/// The number of the mode that a block begins with, whose code is read. Throws Damage.
[[nodiscard]] std::size_t read_uastc_mode(BitReader& bits);
[[nodiscard]] const UastcMode& uastc_mode(std::size_t index);

}  // namespace basis
