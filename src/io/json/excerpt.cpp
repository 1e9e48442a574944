#include "io/json/excerpt.hpp"

#include "base/text/printable.hpp"

#include <algorithm>

namespace microtrace::io {
namespace {

constexpr std::size_t kWidth = 120;
constexpr std::size_t kBefore = 80;  // maximum number of columns left of the caret

}  // namespace

Place place_of(std::string_view text, std::size_t offset) {
  const std::string_view left = text.substr(0, offset);
  const auto lines = static_cast<std::size_t>(std::count(left.begin(), left.end(), '\n'));
  const std::size_t start = lines == 0 ? 0 : left.rfind('\n') + 1;
  return {lines + 1, left.size() - start + 1};
}

std::string excerpt(std::string_view text, std::size_t offset) {
  offset = std::min(offset, text.size());
  // Only this many bytes on each side of the offset are examined.
  constexpr std::size_t kReach = 2 * kWidth;
  const std::size_t first = offset - std::min(offset, kReach);
  const std::size_t newline = text.substr(first, offset - first).rfind('\n');
  const std::size_t line_start = newline == text.npos ? first : first + newline + 1;
  const std::string_view right = text.substr(offset, kReach);
  std::size_t line_end = offset + std::min(right.find('\n'), right.size());
  if (line_end > offset && text[line_end - 1] == '\r') --line_end;

  const bool is_short = line_end - line_start <= kWidth;
  std::size_t start = is_short ? line_start : offset - std::min(offset - line_start, kBefore);
  while (start > line_start && start < offset && continues_character(text[start])) ++start;
  const std::size_t end = std::min(line_end, start + kWidth);

  const PrintableText left = make_printable(text.substr(start, offset - start));
  std::string_view rest = text.substr(offset, end - offset);
  if (end < line_end) rest = whole_characters(rest);
  std::string out = start > line_start ? "..." : "";
  const std::size_t caret = out.size() + left.columns;
  out.append(left.text).append(make_printable(rest).text).append(end < line_end ? "..." : "");
  return out.append("\n").append(caret, ' ').append("^");
}

}  // namespace microtrace::io
