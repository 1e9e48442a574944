#include "io/gltf/document/asset_json.hpp"

#include "base/memory_account.hpp"
#include "base/text/printable.hpp"

#include <microtrace/error.hpp>

#include <cstddef>

namespace microtrace::io::gltf {
namespace {

/// Returns the text with each byte that is not UTF-8 as the character of Latin-1.
std::string utf8_of(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length > 0) {
      result += text.substr(0, length);
    } else {
      const auto byte = static_cast<unsigned char>(text[0]);
      result += {static_cast<char>(0xC0 | byte >> 6), static_cast<char>(0x80 | (byte & 0x3F))};
    }
    text.remove_prefix(length > 0 ? length : 1);
  }
  return result;
}

}  // namespace

AssetJson::AssetJson(std::string_view text, const std::string& name)
    : document_(parsed(text, name)) {}

JsonDocument AssetJson::parsed(std::string_view text, const std::string& name) {
  const auto parse = [&](std::string_view bytes) {
    return JsonDocument(bytes, name, kMaxJsonValues, RepeatedKeys::last_counts);
  };
  try {
    return parse(text);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::invalid_scene) throw;
    take_memory(2 * text.size(), "the JSON");
    converted_ = utf8_of(text);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const bool is_object = first != std::string_view::npos && text[first] == '{';
    if (!is_object || converted_ == text) throw;
    return parse(converted_);
  }
}

}  // namespace microtrace::io::gltf
