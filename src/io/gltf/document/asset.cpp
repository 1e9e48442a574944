#include "io/gltf/document/asset.hpp"

#include "base/memory_account.hpp"
#include "io/json/parse/tree_memory.hpp"

#include <algorithm>
#include <utility>

namespace microtrace::io::gltf {

Element Element::member(std::string_view key) const {
  const JsonValue* found = value->find(key);
  return {found != nullptr ? found : value, child(pointer, key)};
}

Element Element::item(std::size_t index) const {
  const JsonValue* found = value->find(index);
  return {found != nullptr ? found : value, child(pointer, index)};
}

Asset::Asset(JsonDocument& json) : json_(json) {
  if (const OutdoneKeys& outdone = json.outdone_keys(); outdone.count > 0) {
    JsonValue key;
    key.offset = static_cast<std::uint32_t>(outdone.offset);
    note({&key, outdone.pointer}, "occurs twice in its object; the last one is used",
         Severity::error, outdone.count);
  }
  for (const JsonValue& item : array("extensionsUsed")) used_.insert(item.string());
  for (const JsonValue& item : array("extensionsRequired")) required_.insert(item.string());
}

const std::vector<JsonValue>& Asset::array(std::string_view name) const {
  static const std::vector<JsonValue> none;
  const JsonValue* found = json_.root().find(name);
  return found != nullptr ? found->items() : none;
}

Element Asset::element(std::string_view name, std::size_t index) const {
  return root().member(name).item(index);
}

const JsonValue* Asset::find(std::string_view pointer) const {
  return resolve(json_.root(), pointer);
}

bool Asset::uses(std::string_view extension) const {
  return used_.contains(extension);
}

bool Asset::requires_extension(std::string_view extension) const {
  return required_.contains(extension);
}

void Asset::drop(const Element& object, const std::unordered_set<std::string_view>& keys) {
  resolve(json_.root(), object.pointer)->remove_members([&](std::string_view key) {
    return keys.contains(key);
  });
}

void Asset::forget(std::string_view name, std::size_t index,
                   std::span<const std::string_view> keys) {
  JsonValue& item = *json_.root().find(name)->find(index);
  std::uint64_t bytes = 0;
  const auto is_forgotten = [&](std::string_view key) {
    return std::ranges::find(keys, key) != keys.end();
  };
  for (const JsonMember& member : item.members())
    if (is_forgotten(member.key)) bytes += TreeMemory::bytes_of(member);
  item.remove_members(is_forgotten);
  if (item.members().empty()) item.set(JsonValue());
  memory_account().give_back(bytes);
}

void Asset::set(const Element& at, double number) {
  resolve(json_.root(), at.pointer)->set(JsonValue(number));
}

void Asset::fail(const Element& at, std::string message, ErrorKind kind) const {
  throw Error(kind, json_.at(at.value->offset, at.pointer, std::move(message)));
}

void Asset::fail(const Element& at, std::string message, const Error& cause) const {
  json_.fail(at.value->offset, at.pointer, std::move(message), cause);
}

void Asset::warn(const Element& at, const std::string& message) {
  note(at, message, Severity::warning, 1);
}

void Asset::tolerate(const Element& at, const std::string& message) {
  note(at, message, Severity::error, 1);
}

void Asset::note(const Element& at, const std::string& message, Severity severity,
                 std::size_t places) {
  Warning& warning = warnings_[message];
  warning.severity = std::max(warning.severity, severity);
  if (warning.count == 0 || at.value->offset < warning.offset) {
    warning.offset = at.value->offset;
    warning.pointer = at.pointer;
  }
  warning.count += places;
}

std::vector<Diagnostic> Asset::warnings() const {
  constexpr std::size_t kShown = 100;  // limited because finding a warning's line takes time
  std::vector<std::pair<std::string, Warning>> sorted(warnings_.begin(), warnings_.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second.offset, a.first) < std::pair(b.second.offset, b.first);
  });
  std::vector<Diagnostic> result;
  for (std::size_t i = 0; i < std::min(sorted.size(), kShown); ++i) {
    auto& [message, warning] = sorted[i];
    if (warning.count > 1) message += " (" + std::to_string(warning.count) + " places)";
    result.push_back(json_.at(warning.offset, warning.pointer, message));
    result.back().severity = warning.severity;
  }
  if (sorted.size() > kShown) {
    Diagnostic& last = result.emplace_back();
    last.file = json_.file();
    last.message = std::to_string(sorted.size() - kShown) + " more warnings are left out";
    for (std::size_t i = kShown; i < sorted.size(); ++i) {
      last.severity = std::max(last.severity, sorted[i].second.severity);
    }
  }
  return result;
}

}  // namespace microtrace::io::gltf
