#pragma once
/// Parses the command lines of benchmarks.

#include <string>
#include <string_view>
#include <vector>

namespace microtrace::bench {

/// Parses a number from 1 to 1024. Throws std::invalid_argument for any other text.
[[nodiscard]] unsigned number(std::string_view text);

/// Splits a list at its commas.
[[nodiscard]] std::vector<std::string> split_names(const std::string& text);

}  // namespace microtrace::bench
