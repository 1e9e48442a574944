#include "io/json/parse/token.hpp"

#include <algorithm>

namespace microtrace::io {

// These are loops, because find_first_of() and the like call a function for each character.

StringExtent string_extent(std::string_view text, std::size_t start) {
  bool is_verbatim = true;
  std::size_t at = start + 1;
  for (; at < text.size(); ++at) {
    const auto c = static_cast<unsigned char>(text[at]);
    if (c == '"') return {.end = at + 1, .is_closed = true, .is_verbatim = is_verbatim};
    if (c < ' ') break;
    if (c == '\\') ++at;
    is_verbatim &= c != '\\' && c < 0x80;
  }
  return {.end = std::min(at, text.size()), .is_closed = false, .is_verbatim = is_verbatim};
}

std::size_t number_end(std::string_view text, std::size_t start) {
  const auto at = [&](std::size_t offset) { return offset < text.size() ? text[offset] : '\0'; };
  const auto digits = [&](std::size_t offset) {
    while (at(offset) >= '0' && at(offset) <= '9') ++offset;
    return offset;
  };
  std::size_t end = start + (at(start) == '-' ? 1 : 0);
  end = at(end) == '0' ? end + 1 : digits(end);
  if (at(end) == '.') end = digits(end + 1);
  if (at(end) != 'e' && at(end) != 'E') return end;
  const bool has_sign = at(end + 1) == '+' || at(end + 1) == '-';
  return digits(end + (has_sign ? 2 : 1));
}

}  // namespace microtrace::io
