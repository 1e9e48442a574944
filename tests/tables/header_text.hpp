#pragma once
/// The text of a header with tables.

#include "tables/stated_errors.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace microtrace::tables {

/// The value with this number of decimals and the suffix F, or as an integer if there are no
/// decimals.
[[nodiscard]] std::string number_text(double value, int decimals);

/// The value that number_text() writes.
[[nodiscard]] double rounded(double value, int decimals);

/// Braces of nested std::array with these sizes, innermost last, and the values in between.
[[nodiscard]] std::string nested_text(std::span<const double> values,
                                      std::span<const std::size_t> sizes, int decimals);

/// "inline constexpr TYPE NAME = ...;"
[[nodiscard]] std::string table_text(const std::string& type_and_name,
                                     std::span<const double> values,
                                     const std::vector<std::size_t>& sizes, int decimals);

/// "/// TEXT" in lines of at most 100 columns. Keeps blank lines, and lines that start with two
/// spaces.
[[nodiscard]] std::string comment_text(const std::string& text);

/// "0.006 | -0.0006 | 0.0004", cells of the table in docs/derivations.md.
[[nodiscard]] std::string cells_text(const StatedError& error);

/// "at most 0.006 above and 0.0006 below the integral, rms 0.0004"
[[nodiscard]] std::string error_text(const StatedError& error);

/// The whole header: comment, includes and content. Adds to the comment that the file is generated.
[[nodiscard]] std::string header_text(const std::string& comment,
                                      const std::vector<std::string>& includes,
                                      const std::string& content);

}  // namespace microtrace::tables
