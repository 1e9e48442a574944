#include "base/text/index_text.hpp"
#include "io/json/document.hpp"

#include <algorithm>
#include <optional>

namespace microtrace::io {
namespace {

/// Decodes ~1 to / and ~0 to ~. Returns nothing if a ~ is followed by any other character.
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

/// Finds the value that a pointer names. Value is JsonValue or const JsonValue.
template <typename Value>
Value* step(Value& value, const std::string& token) {
  if (value.kind() != JsonValue::Kind::array) return value.find(token);
  const std::optional<std::size_t> index = array_index(token);
  return index ? value.find(*index) : nullptr;
}

template <typename Value>
Value* resolved(Value& root, std::string_view pointer) {
  const std::optional<std::vector<std::string>> tokens = pointer_tokens(pointer);
  if (!tokens) return nullptr;
  Value* value = &root;
  for (const std::string& token : *tokens) {
    value = step(*value, token);
    if (value == nullptr) return nullptr;
  }
  return value;
}

}  // namespace

std::string child(const std::string& pointer, std::string_view key) {
  std::string out = pointer + "/";
  for (const char c : key) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += c;
    }
  }
  return out;
}

std::string child(const std::string& pointer, std::size_t index) {
  return pointer + "/" + std::to_string(index);
}

std::optional<std::vector<std::string>> pointer_tokens(std::string_view pointer) {
  std::vector<std::string> tokens;
  while (!pointer.empty()) {
    if (pointer[0] != '/') return std::nullopt;
    const std::string_view rest = pointer.substr(1);
    std::optional<std::string> token = unescaped(rest.substr(0, rest.find('/')));
    if (!token) return std::nullopt;
    tokens.push_back(*std::move(token));
    pointer = rest.substr(std::min(rest.find('/'), rest.size()));
  }
  return tokens;
}

std::optional<std::size_t> array_index(std::string_view token) {
  const bool has_leading_zero = token.size() > 1 && token.starts_with('0');
  return has_leading_zero ? std::nullopt : index_in(token);
}

const JsonValue* resolve(const JsonValue& root, std::string_view pointer) {
  return resolved(root, pointer);
}

JsonValue* resolve(JsonValue& root, std::string_view pointer) {
  return resolved(root, pointer);
}

}  // namespace microtrace::io
