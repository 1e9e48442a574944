#pragma once
/// Writes the text of a header with tables.

#include "tables/stated_errors.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace microtrace::tables {

/// Returns the value with this number of decimals and the suffix F. Without decimals, returns an
/// integer.
[[nodiscard]] std::string number_text(double value, int decimals);

/// Returns the value that number_text() writes.
[[nodiscard]] double rounded(double value, int decimals);

/// Returns the values in the braces of nested std::arrays with these sizes, of which the innermost
/// is last.
[[nodiscard]] std::string nested_text(std::span<const double> values,
                                      std::span<const std::size_t> sizes, int decimals);

/// Returns "inline constexpr TYPE NAME = ...;".
[[nodiscard]] std::string table_text(const std::string& type_and_name,
                                     std::span<const double> values,
                                     const std::vector<std::size_t>& sizes, int decimals);

/// Returns "/// TEXT" in lines of at most 100 columns. Keeps blank lines, and lines that start with
/// two spaces.
[[nodiscard]] std::string comment_text(const std::string& text);

/// Returns cells for the table in docs/derivations.md, such as "0.006 | -0.0006 | 0.0004".
[[nodiscard]] std::string cells_text(const StatedError& error);

/// Returns a text such as "at most 0.006 above and 0.0006 below the integral, rms 0.0004".
[[nodiscard]] std::string error_text(const StatedError& error);

/// Returns the whole header: comment, includes and content. The comment also states that the file
/// is generated.
[[nodiscard]] std::string header_text(const std::string& comment,
                                      const std::vector<std::string>& includes,
                                      const std::string& content);

}  // namespace microtrace::tables
