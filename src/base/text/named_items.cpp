#include "base/text/named_items.hpp"

#include "base/text/index_text.hpp"
#include "base/text/printable.hpp"

#include <algorithm>

namespace microtrace {

std::optional<std::size_t> find_item(std::string_view wanted, std::span<const std::string> names) {
  const auto named = std::ranges::find(names, wanted);
  if (!wanted.empty() && named != names.end())
    return static_cast<std::size_t>(named - names.begin());
  const std::optional<std::size_t> index = index_in(wanted);
  return index && *index < names.size() ? index : std::nullopt;
}

std::string no_such_item(std::string_view kind, std::string_view wanted,
                         std::span<const std::string> names) {
  constexpr std::size_t kShown = 20, kLength = 64;
  std::string text = "there is no ";
  text.append(kind).append(" ").append(in_quotes(wanted));
  if (names.empty()) return text += "; the scene has none";
  text += "; choose ";
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
    const std::string name = names[i].empty() ? "unnamed" : printable(names[i].substr(0, kLength));
    text.append(i == 0 ? "" : ", ").append(std::to_string(i)).append(" (").append(name).append(")");
  }
  if (names.size() > kShown) text.append(", ... ").append(std::to_string(names.size() - 1));
  return text;
}

}  // namespace microtrace
