#include "arguments.hpp"

#include <charconv>
#include <stdexcept>

namespace microtrace::bench {

unsigned number(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value == 0 || value > 1024)
    throw std::invalid_argument("not a number from 1 to 1024: " + std::string(text));
  return value;
}

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names{""};
  for (const char c : text) {
    if (c == ',')
      names.emplace_back();
    else
      names.back() += c;
  }
  return names;
}

}  // namespace microtrace::bench
