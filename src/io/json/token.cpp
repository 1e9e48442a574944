#include "io/json/token.hpp"

namespace microtrace::io {

// These are loops, because find_first_of() and the like call a function for each character.

std::size_t string_end(std::string_view text, std::size_t start) {
  std::size_t end = start + 1;
  while (text[end] != '"') end += text[end] == '\\' ? 2 : 1;
  return end + 1;
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
