#pragma once
#include <cstddef>
#include <string>

namespace microtrace {

/// Returns "1 view" or "2 views" for the noun "view".
[[nodiscard]] inline std::string counted(std::size_t number, const char* noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

}  // namespace microtrace
