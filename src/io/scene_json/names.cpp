#include "io/scene_json/names.hpp"

#include "base/text/printable.hpp"

namespace microtrace::io {

std::string Names::read(const JsonReader& json) {
  const auto given = json.find("name");
  std::string name = given ? given->name() : json.pointer().substr(1);
  const auto [earlier, is_new] = pointers_.emplace(name, json.pointer());
  if (!is_new) {
    std::string message = "the name ";
    message.append(in_quotes(name)).append(" is already used by ").append(earlier->second);
    (given ? *given : json).fail(message.append("; names must differ"));
  }
  return name;
}

}  // namespace microtrace::io
