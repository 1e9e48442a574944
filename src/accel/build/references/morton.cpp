#include "accel/build/references/morton.hpp"

namespace microtrace::build {
namespace {

constexpr unsigned kAxisBits = 16;

// For smaller extents, the reciprocal could overflow.
constexpr float kLeastExtent = 0x1p-110F;

std::size_t longest_axis(Float4 extent) {
  return extent[0] >= extent[1] && extent[0] >= extent[2] ? 0 : extent[1] >= extent[2] ? 1 : 2;
}

}  // namespace

MortonCode::MortonCode(const Box& box, unsigned bits) : origin_(xyz(box.lo)) {
  Float4 whole = xyz(box.hi) - xyz(box.lo);
  whole = whole > kLeastExtent ? whole : splat(0);
  Float4 extent = whole;
  std::array<unsigned, 3> used{};
  std::array<std::array<std::uint32_t, kAxisBits>, 3> places{};  // from each axis's highest bit
  for (unsigned place = bits; place-- > 0;) {
    const std::size_t longest = longest_axis(extent);
    if (extent[longest] == 0 || used[longest] == kAxisBits) break;
    places[longest][used[longest]++] = std::uint32_t{1} << place;
    extent[longest] *= 0.5F;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto cells = static_cast<float>(1U << used[axis]);
    last_[axis] = cells - 1;
    if (used[axis] > 0) scale_[axis] = cells * 0.9999F / whole[axis];
    for (unsigned bit = 0; bit < used[axis]; ++bit) {
      Table& table = spread_[axis][bit / 8];
      const std::size_t half = std::size_t{1} << bit % 8;
      for (std::size_t i = 0; i < half; ++i)
        table[half + i] = table[i] | places[axis][used[axis] - 1 - bit];
    }
  }
}

}  // namespace microtrace::build
