#include "cli/options/option_value.hpp"

#include "base/text/printable.hpp"
#include "base/text/split_at_commas.hpp"

#include <microtrace/error.hpp>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>

namespace microtrace::cli {
namespace {

/// Converts the text; nothing unless all of it is a number.
template <typename Number>
std::optional<Number> read(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string shortest(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

std::optional<std::uint32_t> whole_number(std::string_view text) {
  return read<std::uint32_t>(text);
}

std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view part : split_at_commas(text)) {
    const auto number = read<double>(part);
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

std::string listed(std::span<const std::string> words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 < words.size() ? ", " : " or ";
    text += words[i];
  }
  return text;
}

void refuse_usage(const std::string& message) {
  throw Error(ErrorKind::usage, "", message);
}

void OptionValue::refuse(const std::string& accepted) const {
  refuse_usage(option + ": expects " + accepted + ", not " + text);
}

std::uint32_t OptionValue::whole_number(std::uint32_t least, std::uint32_t most) const {
  const std::optional<std::uint32_t> number = cli::whole_number(text);
  if (!number || *number < least || *number > most) {
    refuse_usage(option + ": must be a whole number from " + std::to_string(least) + " to " +
                 std::to_string(most) + ", is " + in_quotes(text));
  }
  return *number;
}

double OptionValue::number() const {
  const auto value = read<double>(text);
  if (!value || !std::isfinite(*value)) refuse("a number");
  return *value;
}

double OptionValue::number(double least, double most) const {
  const double value = number();
  if (value < least || value > most) {
    const bool is_bounded = most < std::numeric_limits<double>::max();
    refuse("a number from " + shortest(least) + (is_bounded ? " to " + shortest(most) : " up"));
  }
  return value;
}

double OptionValue::positive_number() const {
  const double value = number();
  if (!(value > 0)) refuse("a number above 0");
  return value;
}

DVec3 OptionValue::point() const {
  const std::vector<double> numbers = numbers_of(text);
  if (numbers.size() != 3) refuse("three numbers x,y,z");
  return {numbers[0], numbers[1], numbers[2]};
}

std::uint64_t OptionValue::bytes() const {
  constexpr std::string_view kUnits = "KMG";
  const std::size_t unit = text.empty() ? kUnits.npos : kUnits.find(text.back());
  const bool has_unit = unit != kUnits.npos;
  const auto number =
      read<std::uint64_t>(std::string_view(text).substr(0, text.size() - (has_unit ? 1 : 0)));
  const std::size_t shift = has_unit ? 10 * (unit + 1) : 0;
  if (!number || *number == 0 || *number > std::numeric_limits<std::uint64_t>::max() >> shift)
    refuse("a number of bytes above 0, or of KiB, MiB or GiB such as 512M or 4G");
  return *number << shift;
}

}  // namespace microtrace::cli
