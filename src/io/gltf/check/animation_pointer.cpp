#include "io/gltf/check/animation_pointer.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace microtrace::io::gltf {
std::string why_no_pointer(const Asset& asset, std::string_view text) {
  if (!text.starts_with('/')) return "is not a JSON pointer, which begins with /";
  const std::optional<std::vector<std::string>> tokens = pointer_tokens(text);
  if (!tokens) return "is not a JSON pointer: ~ must be followed by 0 or 1";
  const JsonValue* value = asset.root().value;
  for (std::size_t i = 0; i < tokens->size(); ++i) {
    if (value->kind() == JsonValue::Kind::array) {
      const std::optional<std::size_t> index = array_index((*tokens)[i]);
      if (!index || *index >= value->items().size()) {
        return "points to item " + (*tokens)[i] + " of an array that has " +
               std::to_string(value->items().size());
      }
      value = &value->items()[*index];
      continue;
    }
    const JsonValue* member = value->find((*tokens)[i]);
    if (member == nullptr && i == 0) return "points to an array that the asset does not have";
    if (member == nullptr) return {};
    value = member;
  }
  return tokens->size() < 2 ? "points to a whole array" : "";
}

}  // namespace microtrace::io::gltf
