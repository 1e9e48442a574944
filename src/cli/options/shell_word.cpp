#include "cli/options/shell_word.hpp"

#include <algorithm>
#include <string_view>

namespace microtrace::cli {

std::string in_single_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += R"('\'')";
    } else {
      out += c;
    }
  }
  return out + "'";
}

std::string shell_word(const std::string& word) {
  constexpr std::string_view kSpecial = " !\"#$&'()*;<>?[\\]^`{|}~";
  return std::ranges::find_first_of(word, kSpecial) == word.end() ? word : in_single_quotes(word);
}

}  // namespace microtrace::cli
