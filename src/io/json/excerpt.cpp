#include "io/json/excerpt.hpp"

#include <algorithm>
#include <array>

namespace microtrace::io {
namespace {

constexpr std::size_t width = 120;
constexpr std::size_t before = 80;  // of them, at most, left of the caret

bool continues(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

struct CodePoint {
  char32_t value = 0;
  std::size_t length = 0;  ///< in bytes, 0 if the bytes are not UTF-8
};

/// The code point that `text`, not empty, starts with.
CodePoint decode(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return {lead, 1};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return {};
  char32_t value = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if (!continues(text[i])) return {};
    value = (value << 6U) | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  const bool overlong = (length == 3 && value < 0x800) || (length == 4 && value < 0x10000);
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (overlong || surrogate || value > 0x10FFFF) return {};
  return {value, length};
}

/// Control characters, and those without width or that turn the reading order.
bool is_dangerous(char32_t c) {
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || (c >= 0x200B && c <= 0x200F) ||
         (c >= 0x2028 && c <= 0x202E) || (c >= 0x2060 && c <= 0x206F) || c == 0xFEFF;
}

struct Shown {
  std::string text;
  std::size_t columns = 0;
};

void show_bytes(std::string_view bytes, Shown& out) {
  constexpr std::string_view digits = "0123456789abcdef";
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    out.text += {'\\', 'x', digits[byte >> 4U], digits[byte & 15U]};
    out.columns += 4;
  }
}

Shown show(std::string_view text) {
  Shown out;
  while (!text.empty()) {
    const CodePoint c = decode(text);
    const std::string_view bytes = text.substr(0, std::max<std::size_t>(c.length, 1));
    if (text[0] == '\t') {
      out.text += ' ';
      ++out.columns;
    } else if (c.length == 0 || is_dangerous(c.value)) {
      show_bytes(bytes, out);
    } else {
      out.text += bytes;
      ++out.columns;
    }
    text.remove_prefix(bytes.size());
  }
  return out;
}

std::string_view whole_characters(std::string_view text) {
  std::size_t end = text.size();
  while (end > 0 && text.size() - end < 3 && continues(text[end - 1])) --end;
  // An unfinished last character starts at end - 1.
  if (end > 0 && decode(text.substr(end - 1)).length == 0) return text.substr(0, end - 1);
  return text;
}

}  // namespace

Place place_of(std::string_view text, std::size_t offset) {
  const std::string_view left = text.substr(0, offset);
  const auto lines = static_cast<std::size_t>(std::count(left.begin(), left.end(), '\n'));
  const std::size_t start = left.rfind('\n') + 1;  // npos + 1 is 0
  return {lines + 1, left.size() - start + 1};
}

std::string excerpt(std::string_view text, std::size_t offset) {
  offset = std::min(offset, text.size());
  const std::size_t line_start = text.substr(0, offset).rfind('\n') + 1;
  std::size_t line_end = std::min(text.find('\n', offset), text.size());
  if (line_end > offset && text[line_end - 1] == '\r') --line_end;

  const bool is_short = line_end - line_start <= width;
  std::size_t start = is_short ? line_start : offset - std::min(offset - line_start, before);
  while (start > line_start && start < offset && continues(text[start])) ++start;
  const std::size_t end = std::min(line_end, start + width);

  const Shown left = show(text.substr(start, offset - start));
  std::string_view rest = text.substr(offset, end - offset);
  if (end < line_end) rest = whole_characters(rest);
  std::string out = start > line_start ? "..." : "";
  const std::size_t caret = out.size() + left.columns;
  out.append(left.text).append(show(rest).text).append(end < line_end ? "..." : "");
  return out.append("\n").append(caret, ' ').append("^");
}

std::string in_quotes(std::string_view name) {
  constexpr std::size_t limit = 60;
  std::string out = "\"";
  if (name.size() <= limit) return out.append(show(name).text).append("\"");
  return out.append(show(whole_characters(name.substr(0, limit))).text).append("...\"");
}

std::string printable(std::string_view text) {
  return show(text).text;
}

}  // namespace microtrace::io
