#include "tables/header_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

namespace microtrace::tables {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kEnd = 13;  // characters after the last number of five nested arrays

std::string shortest(double value) {
  std::array<char, 64> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  return {text.data(), end.ptr};
}

}  // namespace

std::string number_text(double value, int decimals) {
  std::array<char, 64> text{};
  if (decimals == 0) {
    const auto end = std::to_chars(text.data(), text.data() + text.size(), std::lround(value));
    return {text.data(), end.ptr};
  }
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, decimals);
  std::string result(text.data(), end.ptr);
  if (result.find_first_not_of("-0.") == std::string::npos && result[0] == '-') result.erase(0, 1);
  return result + 'F';
}

double rounded(double value, int decimals) {
  const std::string text = number_text(value, decimals);
  double result = 0;
  std::from_chars(text.data(), text.data() + text.size(), result);
  return result;
}

std::string nested_text(std::span<const double> values, std::span<const std::size_t> sizes,
                        int decimals) {
  std::string result;
  if (sizes.size() > 1) {
    const std::size_t part = values.size() / sizes[0];
    for (std::size_t i = 0; i < sizes[0]; ++i) {
      if (i > 0) result += ",\n";
      result += nested_text(values.subspan(i * part, part), sizes.subspan(1), decimals);
    }
    return "{{" + result + "}}";
  }
  std::size_t column = 2;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string text = number_text(values[i], decimals);
    if (i > 0) {
      const bool fits = column + text.size() + kEnd <= kColumns;
      result += fits ? ", " : ",\n  ";
      column = fits ? column + 2 : 2;
    }
    result += text;
    column += text.size();
  }
  return "{{" + result + "}}";
}

std::string table_text(const std::string& type_and_name, std::span<const double> values,
                       const std::vector<std::size_t>& sizes, int decimals) {
  const std::string braces = nested_text(values, sizes, decimals);
  return "inline constexpr " + type_and_name + " = {{\n" + braces.substr(2) + ";\n";
}

std::string comment_text(const std::string& text) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.starts_with("  ")) {
      result += line.empty() ? "///\n" : "/// " + line + '\n';
      continue;
    }
    std::istringstream words(line);
    std::string row = "///";
    for (std::string word; words >> word;) {
      if (row.size() + 1 + word.size() > kColumns) {
        result += row + '\n';
        row = "///";
      }
      row += ' ' + word;
    }
    result += row + '\n';
  }
  return result;
}

std::string cells_text(const StatedError& error) {
  return shortest(error.above) + " | " + shortest(-error.below) + " | " + shortest(error.rms);
}

std::string error_text(const StatedError& error) {
  return "at most " + shortest(error.above) + " above and " + shortest(error.below) +
         " below the integral, rms " + shortest(error.rms);
}

std::string header_text(const std::string& comment, const std::vector<std::string>& includes,
                        const std::string& content) {
  std::string result = "#pragma once\n" +
                       comment_text(comment +
                                    "\nWritten by tests/tables/make_tables.cpp; "
                                    "docs/derivations.md derives the integrals.\n") +
                       '\n';
  bool was_own = false;
  for (const std::string& name : includes) {
    const bool is_own = name.find('/') != std::string::npos;
    if (was_own && !is_own) result += '\n';
    result += "#include " + (is_own ? '"' + name + '"' : '<' + name + '>') + '\n';
    was_own = is_own;
  }
  return result + "\nnamespace microtrace::bsdf {\n\n" + content +
         "\n}  // namespace microtrace::bsdf\n";
}

}  // namespace microtrace::tables
