#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace microtrace::dataset {

/// Returns the number as in the file names of BOP, with at least six digits.
[[nodiscard]] inline std::string six_digits(std::uint32_t number) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

}  // namespace microtrace::dataset
