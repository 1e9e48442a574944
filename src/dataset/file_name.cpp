#include "base/text/printable.hpp"

#include <microtrace/dataset.hpp>
#include <microtrace/error.hpp>

#include <algorithm>

namespace microtrace {

std::string dataset_file_name(std::string_view pattern, std::string_view scene, std::uint32_t view,
                              std::string_view name) {
  const auto refuse = [whole = pattern](const std::string& reason) {
    throw Error(ErrorKind::usage, "", "the file name pattern " + printable(whole) + " " + reason);
  };
  std::string result;
  bool is_unique = false;
  while (!pattern.empty()) {
    const std::size_t open = pattern.find('{');
    result += pattern.substr(0, open);
    if (open == pattern.npos) break;
    const std::size_t end = pattern.find('}', open);
    if (end == pattern.npos) refuse("has an opening brace without a closing one");
    const std::string_view field = pattern.substr(open + 1, end - open - 1);
    pattern.remove_prefix(end + 1);
    if (field == "scene") {
      result += scene;
    } else if (field == "name") {
      result += name;
      is_unique = true;
    } else if (field == "view" || (field.size() == 8 && field.starts_with("view:0") &&
                                   field[6] >= '1' && field[6] <= '9' && field[7] == 'd')) {
      const std::size_t width = field.size() == 8 ? static_cast<std::size_t>(field[6] - '0') : 1;
      const std::string number = std::to_string(view);
      result.append(width > number.size() ? width - number.size() : 0, '0').append(number);
      is_unique = true;
    } else {
      refuse("has an unknown field {" + printable(field) +
             "}; the fields are {scene}, {view}, {view:06d} and {name}");
    }
  }
  if (!is_unique) refuse("needs {view} or {name}");
  const std::filesystem::path path(result);
  if (path.is_absolute() || std::ranges::find(path, std::filesystem::path("..")) != path.end())
    refuse("must not lead out of the data set's folder");
  return result;
}

}  // namespace microtrace
