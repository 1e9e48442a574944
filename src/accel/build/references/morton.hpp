#pragma once
/// Codes of points along a space-filling curve. Points with similar codes are close in space. After
/// M. Vinkler, J. Bittner, V. Havran, Extended Morton codes for high performance bounding volume
/// hierarchy construction, 2017.

#include "accel/build/float4.hpp"

#include <array>
#include <cstdint>

namespace microtrace::build {

/// Maps a point in a box to its position along the curve. Each bit halves a part of the box along
/// its longest side.
class MortonCode {
 public:
  /// The codes have at most `bits` bits, up to 32.
  MortonCode(const Box& box, unsigned bits);

  /// True if all points have the same code. Otherwise opposite corners of the box have different
  /// codes.
  [[nodiscard]] bool is_degenerate() const { return (last_[0] + last_[1] + last_[2]) == 0; }

  [[nodiscard]] std::uint32_t operator()(Float4 point) const {
    const Int4 cell = __builtin_convertvector(min((point - origin_) * scale_, last_), Int4);
    std::uint32_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto bits = static_cast<std::uint32_t>(cell[axis]);
      code |= spread_[axis][0][bits & 0xFFU] | spread_[axis][1][bits >> 8U];
    }
    return code;
  }

 private:
  using Table = std::array<std::uint32_t, 256>;

  Float4 origin_, scale_{}, last_{};
  std::array<std::array<Table, 2>, 3> spread_{};  // by axis and byte
};

}  // namespace microtrace::build
