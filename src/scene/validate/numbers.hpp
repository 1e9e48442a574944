#pragma once
/// Rules about ranges of numbers.

#include "scene/validate/validate.hpp"

#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace microtrace {

inline BrokenRule broken_rule(const char* field, std::string message) {
  return {.field = field, .message = std::move(message)};
}

/// Returns the first broken rule.
inline std::optional<BrokenRule> first_of(std::initializer_list<std::optional<BrokenRule>> rules) {
  for (const auto& rule : rules)
    if (rule) return rule;
  return {};
}

/// Checks that low <= x <= high. NaN is outside every range.
inline std::optional<BrokenRule> in_range(const char* field, double x, double low, double high) {
  if (low <= x && x <= high) return {};
  const bool is_open = high == std::numeric_limits<float>::max();
  const std::string range = is_open ? "must be finite and at least " + decimal(low)
                                    : "must be from " + decimal(low) + " to " + decimal(high);
  return broken_rule(field, range + ", is " + decimal(x));
}

/// Checks each component of v.
template <glm::length_t n, class Number>
std::optional<BrokenRule> in_range(const char* field, const glm::vec<n, Number>& v, double low,
                                   double high) {
  for (glm::length_t i = 0; i < n; ++i)
    if (auto rule = in_range(field, double{v[i]}, low, high)) return rule;
  return {};
}

/// Checks that all components of x are finite and at least `low`.
template <class T>
std::optional<BrokenRule> at_least(const char* field, const T& x, double low) {
  return in_range(field, x, low, std::numeric_limits<float>::max());
}

}  // namespace microtrace
