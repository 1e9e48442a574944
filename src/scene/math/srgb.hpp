#pragma once
/// Exact sRGB encoding of linear light in 8 bits (IEC 61966-2-1). The code of v is the integer
/// nearest to 255 times the transfer function of v. The tables are computed at compile time with +
/// - * / only, so results don't depend on the C library.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace microtrace {

/// x^(1/5) for x in (0, 1]. Newton's method descends from 1 until rounding stops it.
constexpr double fifth_root(double x) {
  double r = 1;
  for (;;) {
    const double r4 = (r * r) * (r * r);
    const double next = r - (r - x / r4) / 5;
    if (!(next < r)) return r;
    r = next;
  }
}

/// The linear value of an sRGB value in [0, 1]. Uses x^2.4 = x^2 (x^2)^(1/5).
constexpr double linear_from_srgb(double encoded) {
  if (encoded <= 0.04045) return encoded / 12.92;
  const double x = (encoded + 0.055) / 1.055;
  return x * x * fifth_root(x * x);
}

/// Computes the table whose entry k is the least float32 with a code above k.
constexpr std::array<float, 255> make_srgb_thresholds() {
  std::array<float, 255> thresholds{};
  for (std::size_t k = 0; k < thresholds.size(); ++k) {
    const double exact = linear_from_srgb((static_cast<double>(k) + 0.5) / 255);
    auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(exact));
    if (static_cast<double>(std::bit_cast<float>(bits)) < exact) ++bits;
    thresholds[k] = std::bit_cast<float>(bits);
  }
  return thresholds;
}

inline constexpr std::array<float, 255> kSrgbThresholds = make_srgb_thresholds();

/// The bins divide [2^-13, 1] into 128 parts per octave. Each bin contains at most one threshold.
inline constexpr std::uint32_t kSrgbFirstBin = std::bit_cast<std::uint32_t>(0x1p-13F) >> 16;
inline constexpr std::size_t kSrgbBinCount =
    (std::bit_cast<std::uint32_t>(1.0F) >> 16) - kSrgbFirstBin;

/// Computes the code at the start of each bin.
constexpr std::array<std::uint8_t, kSrgbBinCount> make_srgb_bins() {
  std::array<std::uint8_t, kSrgbBinCount> bins{};
  std::size_t code = 0;
  for (std::uint32_t bin = 0; bin < bins.size(); ++bin) {
    const auto start = std::bit_cast<float>((kSrgbFirstBin + bin) << 16);
    while (code < 255 && start >= kSrgbThresholds[code]) ++code;
    bins[bin] = static_cast<std::uint8_t>(code);
  }
  return bins;
}

inline constexpr std::array<std::uint8_t, kSrgbBinCount> kSrgbBins = make_srgb_bins();

/// The 8-bit sRGB code of a linear value, which is clamped to [0, 1]. NaN gives 0.
constexpr std::uint8_t encode_srgb(float v) {
  if (!(v >= kSrgbThresholds[0])) return 0;
  if (v >= kSrgbThresholds[254]) return 255;
  const std::uint8_t code = kSrgbBins[(std::bit_cast<std::uint32_t>(v) >> 16) - kSrgbFirstBin];
  return static_cast<std::uint8_t>(code + (v >= kSrgbThresholds[code] ? 1 : 0));
}

}  // namespace microtrace
