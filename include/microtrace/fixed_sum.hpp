#pragma once
/// Sums of floating-point numbers that do not depend on the order of the terms.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace microtrace {

/// A sum of multiples of 2^-FractionBits, stored as a two's complement integer with the lowest word
/// first. The sum is exact while its magnitude is below 2^(64 Words - 1 - FractionBits). Unlike
/// floating-point sums, integer sums don't depend on order or grouping.
template <std::size_t Words, int FractionBits>
struct FixedSum {
  __extension__ using Wide = unsigned __int128;

  std::array<std::uint64_t, Words> words{};

  /// Adds x, which must be finite, truncated toward 0 to a multiple of 2^-FractionBits.
  void add(double x) {
    if (x > -0x1p30 && x < 0x1p30) return add_small(x);
    constexpr int kMantissaBits = 52, kBias = 1075;  // x = mantissa 2^(exponent - kBias)
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const int exponent = static_cast<int>(bits >> kMantissaBits & 0x7ffU);
    std::uint64_t mantissa =
        (bits & ((std::uint64_t{1} << kMantissaBits) - 1)) | (std::uint64_t{1} << kMantissaBits);
    int shift = exponent - kBias + FractionBits;
    if (shift < 0) {
      if (shift <= -64) return;  // also true for 0 and subnormal numbers
      mantissa >>= static_cast<unsigned>(-shift);
      shift = 0;
    }
    const auto word = static_cast<std::size_t>(shift) / 64;
    const auto offset = static_cast<unsigned>(shift) % 64;
    FixedSum term;
    if (word < Words) term.words[word] = mantissa << offset;
    if (offset != 0 && word + 1 < Words) term.words[word + 1] = mantissa >> (64 - offset);
    *this += (bits >> 63U) != 0 ? term.negated() : term;
  }

  /// Adds whole 2^-32 + part 2^-FractionBits, where |whole| < 2^62 and |part| < 2^62.
  void add(std::int64_t whole, std::int64_t part) {
    const Wide term = (static_cast<Wide>(whole) << (FractionBits - 32U)) + static_cast<Wide>(part);
    if constexpr (Words == 1) {
      words[0] += static_cast<std::uint64_t>(term);
    } else {
      const Wide sum = (Wide{words[1]} << 64U | words[0]) + term;
      words[0] = static_cast<std::uint64_t>(sum);
      words[1] = static_cast<std::uint64_t>(sum >> 64U);
      if constexpr (Words == 3) {
        if (sum < term) ++words[2];
        if (static_cast<std::uint64_t>(term >> 127U) != 0) --words[2];
      }
    }
  }

  FixedSum& operator+=(const FixedSum& other) {
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < Words; ++i) {
      const std::uint64_t partial = words[i] + carry;
      carry = partial < carry ? 1 : 0;
      words[i] = partial + other.words[i];
      carry += words[i] < partial ? 1 : 0;
    }
    return *this;
  }

  /// Returns the sum in float64. Its words are rounded one by one, so the last bit may differ from
  /// that of the nearest number.
  [[nodiscard]] double value() const {
    const bool is_negative = (words[Words - 1] >> 63U) != 0;
    const FixedSum magnitude = is_negative ? negated() : *this;
    double result = 0;
    for (std::size_t i = Words; i-- > 0;) {
      result = result * 0x1p64 + static_cast<double>(magnitude.words[i]);
    }
    // 2^-FractionBits
    constexpr auto kUnit = std::bit_cast<double>(std::uint64_t{1023 - FractionBits} << 52U);
    return is_negative ? -result * kUnit : result * kUnit;
  }

  [[nodiscard]] bool operator==(const FixedSum&) const = default;

 private:
  /// A faster add() for |x| < 2^30 by conversion to integers.
  void add_small(double x) {
    static_assert(Words <= 3 && FractionBits >= 32 && FractionBits <= 94);
    // Both conversions truncate toward 0; the difference between them is exact.
    const double upper = x * 0x1p32;
    const auto whole = static_cast<std::int64_t>(upper);
    constexpr auto kScale = std::bit_cast<double>(std::uint64_t{1023 + FractionBits - 32} << 52U);
    add(whole, static_cast<std::int64_t>((upper - static_cast<double>(whole)) * kScale));
  }

  [[nodiscard]] FixedSum negated() const {
    FixedSum result;
    std::uint64_t carry = 1;
    for (std::size_t i = 0; i < Words; ++i) {
      result.words[i] = ~words[i] + carry;
      carry = result.words[i] < carry ? 1 : 0;
    }
    return result;
  }
};

}  // namespace microtrace
