#include "cli/frames.hpp"

#include "cli/option_values.hpp"

#include <optional>

#include <CLI/Error.hpp>

namespace microtrace::cli {
namespace {

/// The pattern with the number in its places, and how many there are; nothing where a % stands for
/// something else.
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

FrameRange parse_frames(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const auto first = whole_number(std::string_view(text).substr(0, colon));
    const auto last = whole_number(std::string_view(text).substr(colon + 1));
    if (first && last && *first <= *last && *last <= kMaxFrame) {
      return {.first = *first, .last = *last};
    }
  }
  throw CLI::ValidationError("--frames",
                             "wants FIRST:LAST, whole numbers of at most 999999 in this order, as "
                             "0:47, not " +
                                 text);
}

double parse_fps(const std::string& text) {
  const double fps = parse_number("--fps", text);
  if (fps > 0) return fps;
  throw CLI::ValidationError("--fps", "must be above 0, is " + text);
}

void check_pattern(const char* option, const std::string& pattern) {
  if (pattern == "-") return;
  const std::optional<Filled> one = filled(pattern, 0);
  if (one && one->places == 1) return;
  throw CLI::ValidationError(
      option,
      "must have the frame's number once, as in out_%04d.png (%d for no leading zeros, %% "
      "for %), where --frames is given; it is " +
          pattern);
}

std::filesystem::path frame_path(const std::string& pattern, std::uint32_t frame) {
  return filled(pattern, frame).value_or(Filled{.text = pattern}).text;
}

}  // namespace microtrace::cli
