#include "cli/pictures/frames.hpp"

#include <cstddef>
#include <optional>
#include <string_view>

namespace microtrace::cli {
namespace {

/// A pattern with the frame number inserted, and the number of insertions. filled() returns nothing
/// if % appears in the pattern for any other purpose.
struct Filled {
  std::string text;
  int places = 0;
};

std::optional<Filled> filled(const std::string& pattern, std::uint32_t frame) {
  Filled result;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '%') {
      result.text += pattern[i];
      continue;
    }
    if (pattern.compare(i, 2, "%%") == 0) {
      result.text += '%';
      ++i;
      continue;
    }
    std::size_t width = 0;
    if (pattern.compare(i + 1, 1, "0") == 0) {
      const char digit = i + 2 < pattern.size() ? pattern[i + 2] : ' ';
      if (digit < '1' || digit > '9') return std::nullopt;
      width = static_cast<std::size_t>(digit - '0');
      i += 2;
    }
    if (pattern.compare(i + 1, 1, "d") != 0) return std::nullopt;
    ++i;
    const std::string number = std::to_string(frame);
    if (number.size() < width) result.text.append(width - number.size(), '0');
    result.text += number;
    ++result.places;
  }
  return result;
}

}  // namespace

FrameRange parse_frames(const OptionValue& value) {
  const std::string_view text = value.text;
  const std::size_t colon = text.find(':');
  if (colon != text.npos) {
    const auto first = whole_number(text.substr(0, colon));
    const auto last = whole_number(text.substr(colon + 1));
    if (first && last && *first <= *last && *last <= kMaxFrame) {
      return {.first = *first, .last = *last};
    }
  }
  value.refuse("FIRST:LAST, whole numbers up to 999999 in ascending order, such as 0:47");
}

void check_pattern(const char* option, const std::string& pattern) {
  if (pattern == "-") return;
  const std::optional<Filled> one = filled(pattern, 0);
  if (one && one->places == 1) return;
  refuse_usage(std::string(option) +
               ": must contain the frame number once if --frames is given, such as out_%04d.png "
               "(%d for no leading zeros, %% for %), is " +
               pattern);
}

std::filesystem::path frame_path(const std::string& pattern, std::uint32_t frame) {
  return filled(pattern, frame).value_or(Filled{.text = pattern}).text;
}

}  // namespace microtrace::cli
