#include "io/json/write.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace microtrace::io {
namespace {

/// Replaces the comma after the last item, if there is one, with the closing bracket.
void close(std::string& text, char bracket) {
  if (text.back() == ',') text.pop_back();
  text += bracket;
}

}  // namespace

void append_json(std::string& text, double x) {
  std::array<char, 32> digits{};
  const bool is_integer = std::trunc(x) == x && std::abs(x) <= 0x1p53;
  const std::to_chars_result written =
      is_integer ? std::to_chars(digits.begin(), digits.end(), static_cast<std::int64_t>(x))
                 : std::to_chars(digits.begin(), digits.end(), x, std::chars_format::scientific);
  text.append(digits.begin(), written.ptr);
}

void append_json(std::string& text, std::string_view string) {
  constexpr std::string_view kHex = "0123456789abcdef";
  text += '"';
  for (const char c : string) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20) {
      text.append("\\u00").append({kHex[byte / 16], kHex[byte % 16]});
      continue;
    }
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  text += '"';
}

void append_json(std::string& text, const JsonValue& value,
                 std::span<const std::string_view> left_out) {
  switch (value.kind()) {
    case JsonValue::Kind::null:
      text += "null";
      return;
    case JsonValue::Kind::boolean:
      text += value.boolean() ? "true" : "false";
      return;
    case JsonValue::Kind::number:
      return append_json(text, value.number());
    case JsonValue::Kind::string:
      return append_json(text, value.string());
    case JsonValue::Kind::array:
      text += '[';
      for (const JsonValue& item : value.items()) {
        append_json(text, item, left_out);
        text += ',';
      }
      return close(text, ']');
    case JsonValue::Kind::object:
      text += '{';
      for (const JsonMember& member : value.members()) {
        if (std::ranges::find(left_out, member.key) != left_out.end()) continue;
        append_json(text, member.key);
        text += ':';
        append_json(text, member.value, left_out);
        text += ',';
      }
      return close(text, '}');
  }
}

}  // namespace microtrace::io
