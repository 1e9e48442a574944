#include "dataset/dataset_json.hpp"

#include "io/json/write.hpp"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <system_error>

namespace microtrace {
namespace {

using io::JsonReader;

std::string hexadecimal(std::uint64_t number) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; number >>= 4U) text[i] = kDigits[number & 15U];
  return text;
}

std::uint64_t read_hexadecimal(const JsonReader& json) {
  const std::string text = json.string();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
  if (error != std::errc() || end != text.data() + text.size() || text.size() != 16)
    json.fail("must be 16 hexadecimal digits");
  return number;
}

void append_member(std::string& text, std::string_view name, std::string_view value) {
  io::append_json(text, name);
  text += ": ";
  io::append_json(text, value);
}

}  // namespace

void append_file(std::string& text, const DatasetFile& file) {
  text += '{';
  append_member(text, "name", file.name);
  text.append(", \"size\": ").append(std::to_string(file.size)).append(", ");
  append_member(text, "digest", hexadecimal(file.digest));
  text += '}';
}

std::string text_of(const DatasetIdentity& identity) {
  std::string text = "{\n  ";
  append_member(text, "program", identity.program);
  append_member(text += ",\n  ", "scene", identity.scene);
  append_member(text += ",\n  ", "digest", hexadecimal(identity.digest));
  append_member(text += ",\n  ", "options", identity.options);
  text.append(",\n  \"views\": ").append(std::to_string(identity.views));
  append_member(text += ",\n  ", "folder", identity.folder);
  text += ",\n  \"arguments\": [";
  for (const std::string& argument : identity.arguments) {
    if (text.back() != '[') text += ", ";
    io::append_json(text, argument);
  }
  return text += "]\n}\n";
}

DatasetIdentity identity_of(const JsonReader& root) {
  root.require_object({"program", "scene", "digest", "options", "views", "folder", "arguments"});
  DatasetIdentity identity{.program = root.member("program").string(),
                           .scene = root.member("scene").string(),
                           .digest = read_hexadecimal(root.member("digest")),
                           .options = root.member("options").string(),
                           .folder = root.member("folder").string()};
  const std::uint64_t views = root.member("views").count();
  if (views > 0xffffffff) root.member("views").fail("is too large");
  identity.views = static_cast<std::uint32_t>(views);
  for (const JsonReader& item : root.member("arguments").items())
    identity.arguments.push_back(item.string());
  return identity;
}

DatasetFile read_file_entry(const JsonReader& json) {
  json.require_object({"name", "size", "digest"});
  return {.name = json.member("name").string(),
          .size = json.member("size").count(),
          .digest = read_hexadecimal(json.member("digest"))};
}

}  // namespace microtrace
