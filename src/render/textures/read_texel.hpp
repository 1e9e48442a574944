#pragma once
/// Interpolates between texels.

#include "render/textures/texel_address.hpp"

#include <cstddef>
#include <cstdint>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// The channels of a texel.
typedef float FourFloats __attribute__((vector_size(16)));

/// The weighted mean of four texels. read(index) returns the texel with this index; indices count
/// texels row by row.
template <class Read>
inline FourFloats bilinear_mean(const TexelAddress<1>& at, const Read& read) {
  const auto columns = static_cast<std::size_t>(at.columns);
  const std::size_t top = static_cast<std::size_t>(at.y.first) * columns;
  const std::size_t bottom = static_cast<std::size_t>(at.y.second) * columns;
  const auto left = static_cast<std::size_t>(at.x.first);
  const auto right = static_cast<std::size_t>(at.x.second);
  const float x = at.x.share, y = at.y.share;
  const FourFloats upper = read(top + left) * (1 - x) + read(top + right) * x;
  const FourFloats lower = read(bottom + left) * (1 - x) + read(bottom + right) * x;
  return upper * (1 - y) + lower * y;
}

/// Interpolates texels of the image itself.
template <std::uint32_t kChannels, typename Number>
inline FourFloats image_mean(const Texels& texels, const Number* samples,
                             const TexelAddress<1>& at) {
  const float *color = texels.color, *alpha = texels.alpha;
  return bilinear_mean(at, [=](std::size_t i) {
    const Number* s = samples + kChannels * i;
    constexpr int kGreen = kChannels < 3 ? 0 : 1, kBlue = kChannels < 3 ? 0 : 2;
    const float a = kChannels % 2 == 0 ? alpha[s[kChannels - 1]] : 1;
    return FourFloats{color[s[0]], color[s[kGreen]], color[s[kBlue]], a};
  });
}
template <typename Number>
inline FourFloats image_mean(const Texels& texels, const TexelAddress<1>& at) {
  const auto* samples = static_cast<const Number*>(texels.levels[0]);
  switch (texels.channels) {
    case 1:
      return image_mean<1>(texels, samples, at);
    case 2:
      return image_mean<2>(texels, samples, at);
    case 3:
      return image_mean<3>(texels, samples, at);
    default:
      return image_mean<4>(texels, samples, at);
  }
}

/// Interpolates texels of a mip map.
inline FourFloats mip_mean(const void* samples, const TexelAddress<1>& at) {
  typedef std::uint16_t FourShorts __attribute__((vector_size(8)));
  typedef std::int32_t FourInts __attribute__((vector_size(16)));
  const auto* first = static_cast<const std::uint16_t*>(samples);
  const FourFloats mean = bilinear_mean(at, [=](std::size_t i) {
    FourShorts numbers;
    __builtin_memcpy(&numbers, first + 4 * i, sizeof numbers);
    return __builtin_convertvector(__builtin_convertvector(numbers, FourInts), FourFloats);
  });
  return mean * (1 / 65535.0F);
}

/// The linear values of a texture's channels.
inline FourFloats read_texel(const Texels& texels, const TexelAddress<1>& at) {
  if (at.level > 0) return mip_mean(texels.levels[at.level], at);
  return texels.is_wide ? image_mean<std::uint16_t>(texels, at)
                        : image_mean<std::uint8_t>(texels, at);
}

/// Prefetches the texels that read_texel() reads.
inline void prefetch_texel(const Texels& texels, const TexelAddress<1>& at) {
  const std::size_t size = at.level > 0 ? 8 : texels.channels * (texels.is_wide ? 2U : 1U);
  const char* const samples = static_cast<const char*>(texels.levels[at.level]);
  const auto prefetch = [&](std::int32_t row) {
    const std::size_t texel = static_cast<std::size_t>(row) * static_cast<std::size_t>(at.columns) +
                              static_cast<std::size_t>(at.x.first);
    __builtin_prefetch(samples + texel * size);
  };
  prefetch(at.y.first);
  prefetch(at.y.second);
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
