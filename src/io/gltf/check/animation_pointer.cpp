#include "io/gltf/check/animation_pointer.hpp"

#include "io/gltf/document/index_text.hpp"

#include <algorithm>
#include <optional>

namespace microtrace::io::gltf {
namespace {

/// A reference token as it stands, with ~1 for / and ~0 for ~; nothing where a ~ is neither.
std::optional<std::string> unescaped(std::string_view token) {
  std::string result;
  for (std::size_t i = 0; i < token.size(); ++i) {
    if (token[i] != '~') {
      result += token[i];
      continue;
    }
    if (++i == token.size() || (token[i] != '0' && token[i] != '1')) return std::nullopt;
    result += token[i] == '0' ? '~' : '/';
  }
  return result;
}

}  // namespace

std::string why_no_pointer(const Asset& asset, std::string_view text) {
  if (!text.starts_with('/')) return "is no JSON pointer, which begins with /";
  std::vector<std::string> tokens;
  for (std::size_t start = 1; start <= text.size();) {
    const std::size_t end = std::min(text.find('/', start), text.size());
    std::optional<std::string> token = unescaped(text.substr(start, end - start));
    if (!token) return "is no JSON pointer: after ~ stands neither 0 nor 1";
    tokens.push_back(*std::move(token));
    start = end + 1;
  }
  const JsonValue* value = asset.root().value;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (value->kind == JsonValue::Kind::array) {
      const std::optional<std::size_t> index = index_in(tokens[i]);
      if (!index || *index >= value->items.size()) {
        return "points to item " + tokens[i] + " of an array that has " +
               std::to_string(value->items.size());
      }
      value = &value->items[*index];
      continue;
    }
    const JsonValue* member = value->find(tokens[i]);
    if (member == nullptr && i == 0) return "points to an array that the asset does not have";
    if (member == nullptr) return {};
    value = member;
  }
  return tokens.size() < 2 ? "points to a whole array" : "";
}

}  // namespace microtrace::io::gltf
