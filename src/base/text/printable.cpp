#include "base/text/printable.hpp"

#include <algorithm>

namespace microtrace {
namespace {

struct CodePoint {
  char32_t value = 0;
  std::size_t length = 0;  ///< in bytes; 0 if the bytes are not UTF-8
};

/// Decodes the first code point of `text`, which must not be empty.
CodePoint decode(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return {lead, 1};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return {};
  char32_t value = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if (!continues_character(text[i])) return {};
    value = (value << 6U) | (static_cast<unsigned char>(text[i]) & 0x3FU);
  }
  const bool overlong = (length == 3 && value < 0x800) || (length == 4 && value < 0x10000);
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (overlong || surrogate || value > 0x10FFFF) return {};
  return {value, length};
}

struct CodePoints {
  char32_t first, last;
};

/// Control characters, bidirectional formatting characters and characters that are invisible: those
/// with the property Default_Ignorable_Code_Point of Unicode, but for the variation selectors and
/// joiners that occur in ordinary text.
constexpr CodePoints kDangerous[] = {
    {0x00, 0x1F},       {0x7F, 0xA0 - 1},  {0xAD, 0xAD},     {0x61C, 0x61C},   {0x115F, 0x1160},
    {0x17B4, 0x17B5},   {0x180E, 0x180E},  {0x200B, 0x200F}, {0x2028, 0x202E}, {0x2060, 0x206F},
    {0x3164, 0x3164},   {0xFEFF, 0xFEFF},  {0xFFA0, 0xFFA0}, {0xFFF0, 0xFFFB}, {0x1BCA0, 0x1BCA3},
    {0x1D173, 0x1D17A}, {0xE0000, 0xE0FFF}};

bool is_dangerous(char32_t c) {
  return std::ranges::any_of(kDangerous,
                             [&](const CodePoints& r) { return c >= r.first && c <= r.last; });
}

void show_bytes(std::string_view bytes, PrintableText& out) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    out.text += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 15U]};
    out.columns += 4;
  }
}

}  // namespace

std::size_t character_length(std::string_view text) {
  return decode(text).length;
}

bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

PrintableText make_printable(std::string_view text) {
  PrintableText out;
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
  while (end > 0 && text.size() - end < 3 && continues_character(text[end - 1])) --end;
  // An incomplete last character starts at end - 1.
  if (end > 0 && decode(text.substr(end - 1)).length == 0) return text.substr(0, end - 1);
  return text;
}

std::string in_quotes(std::string_view name) {
  constexpr std::size_t kLimit = 60;
  std::string out = "\"";
  if (name.size() <= kLimit) return out.append(make_printable(name).text).append("\"");
  return out.append(make_printable(whole_characters(name.substr(0, kLimit))).text).append("...\"");
}

std::string printable(std::string_view text) {
  return make_printable(text).text;
}

}  // namespace microtrace
