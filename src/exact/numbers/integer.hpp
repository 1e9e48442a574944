#pragma once
/// Fixed-width integers for exact queries about coordinates on a common grid. Widths are known at
/// compile time: a product is as wide as its factors together, and a sum is as wide as its terms.

#include "exact/numbers/limbs.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace microtrace::exact {

/// An integer of 64 * Limbs bits in two's complement, lowest limb first.
///
/// No overflow occurs if all initial numbers are of type Integer<L> with magnitudes below 2^(64 L -
/// 8). A polynomial of degree k then has a magnitude below c 2^(k (64 L - 8)), where c is the sum
/// of the magnitudes of its coefficients, and is stored in 64 L k bits. All evaluated polynomials
/// have c < 2^(8 k - 1), so they fit.
template <int Limbs>
class Integer {
 public:
  constexpr Integer() = default;  ///< zero

  /// Returns magnitude 2^shift with this sign. The result must fit, and shift must not be negative.
  static Integer shifted(bool is_negative, std::uint64_t magnitude, int shift) {
    const std::uint64_t flipped = is_negative ? ~std::uint64_t{0} : 0;
    Integer result;
    Wide carry = is_negative ? 1 : 0;
    for (int i = 0; i < Limbs; ++i) {
      const int up = shift - 64 * i;
      const std::uint64_t limb = up <= -64 || up >= 64 ? 0
                                 : up >= 0             ? magnitude << up
                                                       : magnitude >> -up;
      carry += limb ^ flipped;
      result.limbs_[static_cast<std::size_t>(i)] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return result;
  }

  [[nodiscard]] bool is_negative() const { return limbs_[Limbs - 1] >> 63U != 0; }

  /// Returns -1, 0 or 1.
  [[nodiscard]] int sign() const {
    if (is_negative()) return -1;
    std::uint64_t any = 0;
    for (const std::uint64_t limb : limbs_) any |= limb;
    return any != 0 ? 1 : 0;
  }

  friend Integer operator+(const Integer& x, const Integer& y) {
    Integer sum;
    Wide carry = 0;
    for (std::size_t i = 0; i < Limbs; ++i) {
      carry += Wide{x.limbs_[i]} + y.limbs_[i];
      sum.limbs_[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    return sum;
  }
  friend Integer operator-(const Integer& x, const Integer& y) {
    Integer difference;
    Wide borrow = 0;
    for (std::size_t i = 0; i < Limbs; ++i) {
      const Wide digit = Wide{x.limbs_[i]} - y.limbs_[i] - borrow;
      difference.limbs_[i] = static_cast<std::uint64_t>(digit);
      borrow = digit >> 64 & 1;
    }
    return difference;
  }
  Integer operator-() const { return Integer() - *this; }

  template <int Others>
  friend Integer<Limbs + Others> operator*(const Integer& x, const Integer<Others>& y) {
    // Multiplies as if both factors were unsigned. If a factor of n limbs is negative, the product
    // is then too large by 2^(64 n) times the other factor.
    Integer<Limbs + Others> product;
    for (std::size_t i = 0; i < Limbs; ++i) {
      Wide carry = 0;
      for (std::size_t j = 0; j < Others; ++j) {
        carry += Wide{x.limb(i)} * y.limb(j) + product.limb(i + j);
        product.limb(i + j) = static_cast<std::uint64_t>(carry);
        carry >>= 64;
      }
      product.limb(i + Others) = static_cast<std::uint64_t>(carry);
    }
    if (x.is_negative()) product.subtract_above(y, Limbs);
    if (y.is_negative()) product.subtract_above(x, Others);
    return product;
  }

  /// Returns the same number with a larger width.
  template <int More>
  [[nodiscard]] Integer<More> widened() const {
    static_assert(More >= Limbs);
    Integer<More> result;
    for (std::size_t i = 0; i < More; ++i)
      result.limb(i) = i < Limbs ? limbs_[i] : is_negative() ? ~std::uint64_t{0} : 0;
    return result;
  }

  /// Multiplies by 2^shift, 0 <= shift < 64 Limbs. The result must fit.
  [[nodiscard]] Integer operator<<(int shift) const {
    const auto whole = static_cast<std::size_t>(shift / 64);
    const int part = shift % 64;
    Integer result;
    for (std::size_t i = whole; i < Limbs; ++i) {
      const std::uint64_t below =
          part == 0 || i == whole ? 0 : limbs_[i - whole - 1] >> (64 - part);
      result.limbs_[i] = limbs_[i - whole] << part | below;
    }
    return result;
  }

  /// Returns the leading bits of the magnitude. The number must not be zero.
  [[nodiscard]] Leading leading() const {
    const Integer size = is_negative() ? -*this : *this;
    std::size_t top = Limbs - 1;
    while (size.limbs_[top] == 0) --top;
    return leading_of(size.limbs_[top], top == 0 ? 0 : size.limbs_[top - 1],
                      static_cast<int>(64 * (top + 1)));
  }

  [[nodiscard]] std::uint64_t limb(std::size_t i) const { return limbs_[i]; }
  std::uint64_t& limb(std::size_t i) { return limbs_[i]; }

  /// Subtracts 2^(64 position) y, modulo the width.
  template <int Others>
  void subtract_above(const Integer<Others>& y, std::size_t position) {
    Wide borrow = 0;
    for (std::size_t i = 0; i + position < Limbs; ++i) {
      const Wide digit = Wide{limbs_[i + position]} - y.limb(i) - borrow;
      limbs_[i + position] = static_cast<std::uint64_t>(digit);
      borrow = digit >> 64 & 1;
    }
  }

 private:
  std::array<std::uint64_t, Limbs> limbs_{};
};

}  // namespace microtrace::exact
