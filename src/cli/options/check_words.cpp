#include "cli/options/check_words.hpp"

#include "base/text/printable.hpp"
#include "cli/options/option_value.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace microtrace::cli {
namespace {

/// Returns the option that the word names, with or without a value. Null if there is none.
const Option* named_by(Command command, std::string_view word) {
  if (!word.starts_with('-')) return nullptr;
  const std::string_view name = word.substr(0, word.find('='));
  for (const OptionGroup& group : option_groups(command)) {
    for (const Option& option : group.options) {
      const std::vector<std::string_view> names = option.all_names();
      if (std::ranges::find(names, name) != names.end()) return &option;
    }
  }
  return nullptr;
}

}  // namespace

void refuse_empty(const std::string& name) {
  refuse_usage(name + ": expects a value, is empty");
}

void check_words(Command command, std::span<char* const> words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--") return;
    const Option* option = named_by(command, word);
    if (option == nullptr) continue;
    const std::size_t equals = word.find('=');
    const std::string name(word.substr(0, equals));
    if (equals != word.npos) {
      if (option->is_switch()) refuse_usage(name + ": takes no value");
      if (!name.starts_with("--"))
        refuse_usage(name + ": omit the = between a short name and its value");
      if (equals + 1 == word.size()) refuse_empty(name);
    } else if (!option->is_flag() && i + 1 < words.size() &&
               named_by(command, words[i + 1]) != nullptr) {
      refuse_usage(name + " expects a value, but is followed by " + printable(words[i + 1]));
    }
  }
}

}  // namespace microtrace::cli
