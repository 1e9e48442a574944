#include "io/json/token.hpp"

#include <algorithm>

namespace microtrace::io {

std::size_t string_end(std::string_view text, std::size_t start) {
  std::size_t end = text.find_first_of("\"\\", start + 1);
  while (text[end] == '\\') end = text.find_first_of("\"\\", end + 2);
  return end + 1;
}

std::size_t number_end(std::string_view text, std::size_t start) {
  const auto at = [&](std::size_t offset) { return offset < text.size() ? text[offset] : '\0'; };
  const auto digits = [&](std::size_t offset) {
    return std::min(text.find_first_not_of("0123456789", offset), text.size());
  };
  std::size_t end = start + (at(start) == '-' ? 1 : 0);
  end = at(end) == '0' ? end + 1 : digits(end);
  if (at(end) == '.') end = digits(end + 1);
  if (at(end) != 'e' && at(end) != 'E') return end;
  const bool has_sign = at(end + 1) == '+' || at(end + 1) == '-';
  return digits(end + (has_sign ? 2 : 1));
}

}  // namespace microtrace::io
