#pragma once
/// Distributes the samples of pixels over slices of time.

#include "render/sampling/dimensions.hpp"
#include "render/sampling/hash.hpp"
#include "render/sampling/sobol.hpp"
#include "simd/bit_reversal.hpp"

#include <bit>
#include <cstdint>

namespace microtrace::sampling {

/// One of `count` slices of time; the count is a power of two.
struct TimeSlice {
  std::uint32_t index = 0, count = 1;
};

/// Returns the least index of a sample that a pixel takes in this slice. Its other samples there
/// follow at distances of slice.count. The slices of samples 0, 1, 2, ... are van der Corput's
/// sequence with Owen scrambling by pixel, so the first 2^n samples are spread evenly over time.
constexpr std::uint32_t first_sample_in(const TimeSlice& slice, std::uint32_t pixel_key) {
  const std::uint32_t seed = hash(pixel_key, kShutterPair);
  // The scrambled index, whose lowest bit is the most significant one of the slice.
  const auto bits = static_cast<std::uint32_t>(std::countr_zero(slice.count));
  const std::uint32_t wanted = bits == 0 ? 0 : reversed_bits(slice.index) >> (32 - bits);
  std::uint32_t sample = 0;
  // Scrambling flips each bit depending on the lower bits, so bits are found from the lowest one.
  for (std::uint32_t bit = 1; bit < slice.count; bit <<= 1U)
    sample |= (scrambled_upwards(sample, seed) ^ wanted) & bit;
  return sample;
}

}  // namespace microtrace::sampling
