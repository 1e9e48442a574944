#pragma once
/// Exact arithmetic on dyadic rationals, the numbers m 2^k with integers m and k. Every finite
/// floating-point number is a dyadic rational, and so are sums, differences and products of dyadic
/// rationals. There is no rounding and no allocation.

#include "exact/numbers/limbs.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace microtrace::exact {

/// A dyadic rational: a sign, and a magnitude in 64-bit limbs. The lowest limb counts multiples of
/// 2^(64 exponent).
///
/// Capacity: a float32 number is a multiple of 2^-149 with a magnitude below 2^128. A polynomial
/// whose terms have degree k in float32 numbers is therefore a multiple of 2^-149k with a magnitude
/// below c 2^128k, where c is the sum of the magnitudes of its coefficients. The largest one
/// compares two roots of quadrics: degree 24, c < 2^37 (derived in docs/exactness.md). Its bits
/// range from 2^(-64*56) to 2^(64*49 - 1), which takes 105 limbs. Before a product is trimmed, it
/// has up to two more limbs, which are zero.
class Dyadic {
 public:
  static constexpr int kCapacity = 112;  ///< number of limbs

  Dyadic() {}            // NOLINT: not "= default", which would initialize the limbs in Dyadic{}
  Dyadic(float value);   ///< exact; value must be finite
  Dyadic(double value);  ///< exact; value must be finite
  Dyadic(const Dyadic& other) { copy(other); }
  Dyadic& operator=(const Dyadic& other) {
    if (this != &other) copy(other);
    return *this;
  }

  /// Returns -1, 0 or 1.
  [[nodiscard]] int sign() const { return sign_; }

  /// Returns the limbs of the magnitude, lowest first. The lowest limb counts multiples of 2^(64
  /// exponent()).
  [[nodiscard]] std::span<const std::uint64_t> limbs() const {
    return {limbs_.data(), static_cast<std::size_t>(size_)};
  }
  [[nodiscard]] int exponent() const { return exponent_; }

  Dyadic operator-() const;
  friend Dyadic operator+(const Dyadic& x, const Dyadic& y) { return sum(x, y, y.sign_); }
  friend Dyadic operator-(const Dyadic& x, const Dyadic& y) { return sum(x, y, -y.sign_); }
  friend Dyadic operator*(const Dyadic& x, const Dyadic& y);

  /// Returns the sign of x - y.
  friend int compare(const Dyadic& x, const Dyadic& y);

  /// Returns the leading bits. The number must not be zero.
  [[nodiscard]] Leading leading() const;

 private:
  explicit Dyadic(const Decoded& value);
  Dyadic(int sign, std::uint64_t mantissa, int exponent);
  void copy(const Dyadic& other);
  void trim();
  /// Returns the position above the highest limb.
  [[nodiscard]] int top() const { return exponent_ + size_; }
  /// Returns the limb that counts multiples of 2^(64 position).
  [[nodiscard]] std::uint64_t at(int position) const {
    const auto index = static_cast<unsigned>(position - exponent_);
    return index < static_cast<unsigned>(size_) ? limbs_[index] : 0;
  }
  /// Returns x + y with the sign of y replaced by sign_of_y.
  static Dyadic sum(const Dyadic& x, const Dyadic& y, int sign_of_y);
  static int compare_magnitudes(const Dyadic& x, const Dyadic& y);
  void add_magnitudes(const Dyadic& x, const Dyadic& y);
  /// Sets the magnitude to |x| - |y|, given |x| > |y|.
  void subtract_magnitudes(const Dyadic& x, const Dyadic& y);

  int sign_ = 0;
  int exponent_ = 0;  // in limbs of 64 bits
  int size_ = 0;      // number of limbs in use, of which the highest and the lowest are nonzero
  std::array<std::uint64_t, kCapacity> limbs_;
};

[[nodiscard]] inline Dyadic twice(const Dyadic& x) {
  return x + x;
}
[[nodiscard]] inline Dyadic square(const Dyadic& x) {
  return x * x;
}

}  // namespace microtrace::exact
