#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace microtrace {

/// The mean of numbers of which each counts at most kMost times the plain mean, so that a bright
/// exception has little effect. The sums are integers, so the result doesn't depend on the order.
class RobustMean {
 public:
  /// `numbers` is a range, and value(number) returns floats, of which the negative and infinite
  /// ones count as 0.
  template <class Numbers, class Value>
  RobustMean(const Numbers& numbers, const Value& value) {
    float greatest = 0;
    for (const auto& number : numbers) greatest = std::max(greatest, finite(value(number)));
    if (greatest == 0) return;
    unit_ = std::ldexp(1.0, 40 - std::ilogb(greatest));
    std::uint64_t sum = 0, limited_sum = 0;
    std::size_t count = 0;
    for (const auto& number : numbers) {
      sum += static_cast<std::uint64_t>(double{finite(value(number))} * unit_);
      ++count;
    }
    most_ = kMost * static_cast<double>(sum) / static_cast<double>(count);
    for (const auto& number : numbers) limited_sum += limited(value(number));
    mean_ = static_cast<double>(limited_sum) / unit_ / static_cast<double>(count);
  }

  [[nodiscard]] double mean() const { return mean_; }
  /// What a number counts, as a multiple of a fixed unit.
  [[nodiscard]] std::uint64_t limited(float value) const {
    return static_cast<std::uint64_t>(std::min(double{finite(value)} * unit_, most_));
  }

 private:
  static constexpr double kMost = 32;

  static float finite(float value) { return value > 0 && std::isfinite(value) ? value : 0; }

  double unit_ = 0, most_ = 0, mean_ = 0;
};

}  // namespace microtrace
