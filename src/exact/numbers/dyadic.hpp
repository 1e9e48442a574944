#pragma once
/// Exact arithmetic on dyadic rationals, the numbers m 2^k with integers m and k. Every finite
/// float is one, and so are their sums, differences and products. There is no rounding and no
/// allocation.

#include "exact/numbers/limbs.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace microtrace::exact {

/// A dyadic rational: a sign, and a magnitude in 64-bit limbs, the lowest of which counts multiples
/// of 2^(64 exponent).
///
/// Capacity: a float32 is a multiple of 2^-149 below 2^128 in magnitude, so a form of degree k in
/// float32 numbers is a multiple of 2^-149k below c 2^128k, where c is the sum of the magnitudes of
/// its coefficients. The largest form compares two roots of quadrics: degree 24, c < 2^37 (derived
/// in docs/exactness.md), so its limbs range from 2^(-64*56) to 2^(64*49 - 1): 105 limbs. Before a
/// product is trimmed it has two more limbs, which are zero.
class Dyadic {
 public:
  static constexpr int kCapacity = 112;  ///< limbs

  Dyadic() {}            // NOLINT: not "= default": the limbs stay uninitialized even in Dyadic{}
  Dyadic(float value);   ///< exact; value is finite
  Dyadic(double value);  ///< exact; value is finite
  Dyadic(const Dyadic& other) { copy(other); }
  Dyadic& operator=(const Dyadic& other) {
    if (this != &other) copy(other);
    return *this;
  }

  /// -1, 0 or 1.
  [[nodiscard]] int sign() const { return sign_; }

  /// The limbs of the magnitude, lowest first. The lowest counts multiples of 2^(64 exponent()).
  [[nodiscard]] std::span<const std::uint64_t> limbs() const {
    return {limbs_.data(), static_cast<std::size_t>(size_)};
  }
  [[nodiscard]] int exponent() const { return exponent_; }

  Dyadic operator-() const;
  friend Dyadic operator+(const Dyadic& x, const Dyadic& y) { return sum(x, y, y.sign_); }
  friend Dyadic operator-(const Dyadic& x, const Dyadic& y) { return sum(x, y, -y.sign_); }
  friend Dyadic operator*(const Dyadic& x, const Dyadic& y);

  /// The sign of x - y.
  friend int compare(const Dyadic& x, const Dyadic& y);

  /// Must not be zero.
  [[nodiscard]] Leading leading() const;

 private:
  explicit Dyadic(const Decoded& value);
  Dyadic(int sign, std::uint64_t mantissa, int exponent);
  void copy(const Dyadic& other);
  void trim();
  /// The position above the highest limb.
  [[nodiscard]] int top() const { return exponent_ + size_; }
  /// The limb that counts multiples of 2^(64 position).
  [[nodiscard]] std::uint64_t at(int position) const {
    const auto index = static_cast<unsigned>(position - exponent_);
    return index < static_cast<unsigned>(size_) ? limbs_[index] : 0;
  }
  /// x + y with the sign of y replaced.
  static Dyadic sum(const Dyadic& x, const Dyadic& y, int sign_of_y);
  static int compare_magnitudes(const Dyadic& x, const Dyadic& y);
  void add_magnitudes(const Dyadic& x, const Dyadic& y);
  /// |x| - |y|, given |x| > |y|.
  void subtract_magnitudes(const Dyadic& x, const Dyadic& y);

  int sign_ = 0;
  int exponent_ = 0;  // in limbs
  int size_ = 0;      // limbs in use; the highest and the lowest are nonzero
  std::array<std::uint64_t, kCapacity> limbs_;
};

[[nodiscard]] inline Dyadic twice(const Dyadic& x) {
  return x + x;
}
[[nodiscard]] inline Dyadic square(const Dyadic& x) {
  return x * x;
}

}  // namespace microtrace::exact
