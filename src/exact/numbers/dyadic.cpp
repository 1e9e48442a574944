#include "exact/numbers/dyadic.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace microtrace::exact {
namespace {

constexpr int kLimbBits = 64;

std::uint64_t low(Wide x) {
  return static_cast<std::uint64_t>(x);
}
std::uint64_t high(Wide x) {
  return static_cast<std::uint64_t>(x >> kLimbBits);
}

}  // namespace

Dyadic::Dyadic(float value) : Dyadic(decode(value)) {
  assert(std::isfinite(value));
}

Dyadic::Dyadic(double value) : Dyadic(decode(value)) {
  assert(std::isfinite(value));
}

Dyadic::Dyadic(const Decoded& value)
    : Dyadic(value.negative ? -1 : 1, value.mantissa, value.exponent) {}

Dyadic::Dyadic(int sign, std::uint64_t mantissa, int exponent) : sign_(sign) {
  const int shift = exponent & (kLimbBits - 1);
  exponent_ = (exponent - shift) / kLimbBits;
  const Wide shifted = Wide{mantissa} << shift;
  limbs_[0] = low(shifted);
  limbs_[1] = high(shifted);
  size_ = 2;
  trim();
}

void Dyadic::copy(const Dyadic& other) {
  sign_ = other.sign_;
  exponent_ = other.exponent_;
  size_ = other.size_;
  std::copy_n(other.limbs_.begin(), size_, limbs_.begin());
}

void Dyadic::trim() {
  while (size_ > 0 && limbs_[static_cast<unsigned>(size_ - 1)] == 0) --size_;
  if (size_ == 0) {
    sign_ = 0;
    exponent_ = 0;
    return;
  }
  int zeros = 0;
  while (limbs_[static_cast<unsigned>(zeros)] == 0) ++zeros;
  if (zeros == 0) return;
  std::copy(limbs_.begin() + zeros, limbs_.begin() + size_, limbs_.begin());
  size_ -= zeros;
  exponent_ += zeros;
}

Dyadic Dyadic::operator-() const {
  Dyadic result = *this;
  result.sign_ = -sign_;
  return result;
}

int Dyadic::compare_magnitudes(const Dyadic& x, const Dyadic& y) {
  if (x.size_ == 0 || y.size_ == 0) return (x.size_ != 0) - (y.size_ != 0);
  if (x.top() != y.top()) return x.top() < y.top() ? -1 : 1;
  const int bottom = std::min(x.exponent_, y.exponent_);
  for (int position = x.top() - 1; position >= bottom; --position) {
    const std::uint64_t a = x.at(position);
    const std::uint64_t b = y.at(position);
    if (a != b) return a < b ? -1 : 1;
  }
  return 0;
}

int compare(const Dyadic& x, const Dyadic& y) {
  if (x.sign_ != y.sign_) return x.sign_ < y.sign_ ? -1 : 1;
  return x.sign_ * Dyadic::compare_magnitudes(x, y);
}

void Dyadic::add_magnitudes(const Dyadic& x, const Dyadic& y) {
  exponent_ = std::min(x.exponent_, y.exponent_);
  const int length = std::max(x.top(), y.top()) - exponent_;
  assert(length < kCapacity);
  std::uint64_t carry = 0;
  for (int i = 0; i < length; ++i) {
    const Wide digit = Wide{x.at(exponent_ + i)} + y.at(exponent_ + i) + carry;
    limbs_[static_cast<unsigned>(i)] = low(digit);
    carry = high(digit);
  }
  limbs_[static_cast<unsigned>(length)] = carry;
  size_ = length + 1;
  trim();
}

void Dyadic::subtract_magnitudes(const Dyadic& x, const Dyadic& y) {
  exponent_ = std::min(x.exponent_, y.exponent_);
  size_ = x.top() - exponent_;
  assert(size_ <= kCapacity);
  std::uint64_t borrow = 0;
  for (int i = 0; i < size_; ++i) {
    const Wide digit = Wide{x.at(exponent_ + i)} - y.at(exponent_ + i) - borrow;
    limbs_[static_cast<unsigned>(i)] = low(digit);
    borrow = high(digit) & 1;
  }
  trim();
}

Dyadic Dyadic::sum(const Dyadic& x, const Dyadic& y, int sign_of_y) {
  Dyadic result;
  if (x.sign_ == 0 || sign_of_y == 0) {
    result = sign_of_y == 0 ? x : y;
    if (x.sign_ == 0) result.sign_ = sign_of_y;
    return result;
  }
  if (x.sign_ == sign_of_y) {
    result.sign_ = x.sign_;
    result.add_magnitudes(x, y);
    return result;
  }
  const int order = compare_magnitudes(x, y);
  if (order == 0) return result;
  result.sign_ = order * x.sign_;
  if (order > 0) {
    result.subtract_magnitudes(x, y);
  } else {
    result.subtract_magnitudes(y, x);
  }
  return result;
}

Dyadic operator*(const Dyadic& x, const Dyadic& y) {
  Dyadic result;
  if (x.sign_ == 0 || y.sign_ == 0) return result;
  result.sign_ = x.sign_ * y.sign_;
  result.exponent_ = x.exponent_ + y.exponent_;
  result.size_ = x.size_ + y.size_;
  assert(result.size_ <= Dyadic::kCapacity);
  std::fill_n(result.limbs_.begin(), result.size_, 0);
  for (unsigned i = 0; i < static_cast<unsigned>(x.size_); ++i) {
    std::uint64_t carry = 0;
    unsigned at = i;
    for (unsigned j = 0; j < static_cast<unsigned>(y.size_); ++j, ++at) {
      const Wide digit = Wide{x.limbs_[i]} * y.limbs_[j] + result.limbs_[at] + carry;
      result.limbs_[at] = low(digit);
      carry = high(digit);
    }
    result.limbs_[at] = carry;
  }
  result.trim();
  return result;
}

Leading Dyadic::leading() const {
  assert(sign_ != 0);
  return leading_of(at(top() - 1), at(top() - 2), kLimbBits * top());
}

}  // namespace microtrace::exact
