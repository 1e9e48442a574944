#pragma once
/// The JSON of one glTF asset. Collects warnings and throws errors about it.

#include "io/json/document.hpp"

#include <microtrace/error.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace microtrace::io::gltf {

/// A value in the asset's JSON, with its JSON pointer.
struct Element {
  const JsonValue* value;
  std::string pointer;

  /// Returns the member with this key. If it is absent, the result has this element's value and the
  /// absent member's pointer.
  [[nodiscard]] Element member(std::string_view key) const;
  /// Returns the item with this index. If it is absent, the result is as for member().
  [[nodiscard]] Element item(std::size_t index) const;
};

class Asset {
 public:
  /// The document must outlive the asset, which modifies it only in drop, forget and set. Warns
  /// about duplicate keys.
  explicit Asset(JsonDocument& json);

  [[nodiscard]] Element root() const { return {&json_.root(), {}}; }
  [[nodiscard]] const std::string& file() const { return json_.file(); }

  /// The items of an array in the root object. Empty if the array is absent.
  [[nodiscard]] const std::vector<JsonValue>& array(std::string_view name) const;
  /// Returns item `index` of the root object's array `name`. The item must exist.
  [[nodiscard]] Element element(std::string_view name, std::size_t index) const;

  /// The value that a JSON pointer names, or null.
  [[nodiscard]] const JsonValue* find(std::string_view pointer) const;
  /// Returns true if extensionsUsed contains the extension.
  [[nodiscard]] bool uses(std::string_view extension) const;
  /// Returns true if extensionsRequired contains the extension.
  [[nodiscard]] bool requires_extension(std::string_view extension) const;

  /// Removes invalid members of an object from the asset's JSON, so no reader sees them. The caller
  /// must warn first. Invalidates Elements within the object.
  void drop(const Element& object, const std::unordered_set<std::string_view>& keys);
  /// Removes members of an item of the root object's array `name`, because their content has been
  /// stored elsewhere. An item without other members becomes null. Gives the memory back to
  /// memory_account(). Invalidates Elements within the item.
  void forget(std::string_view name, std::size_t index, std::span<const std::string_view> keys);
  /// Replaces a number. The caller must warn first.
  void set(const Element& at, double number);

  [[noreturn]] void fail(const Element& at, std::string message,
                         ErrorKind kind = ErrorKind::invalid_scene) const;
  /// Throws an error of the kind of `cause`, which occurred in a file that the value names.
  [[noreturn]] void fail(const Element& at, std::string message, const Error& cause) const;

  /// Adds a warning. Warnings with the same text are merged into one, which states the first place
  /// in the file and the number of places.
  void warn(const Element& at, const std::string& message);
  /// Records a violation of glTF 2.0 that doesn't prevent rendering. It is shown as a warning when
  /// rendering, and as an error when validating.
  void tolerate(const Element& at, const std::string& message);
  /// Returns all warnings in file order. If there are more than 100 different texts, a last warning
  /// states how many are omitted.
  [[nodiscard]] std::vector<Diagnostic> warnings() const;

 private:
  struct Warning {
    std::size_t offset = 0, count = 0;
    std::string pointer;
    Severity severity = Severity::warning;
  };

  /// Records that the message applies to `places` places, of which `at` is the first.
  void note(const Element& at, const std::string& message, Severity severity, std::size_t places);

  JsonDocument& json_;
  std::unordered_set<std::string_view> used_, required_;  // extension names
  std::unordered_map<std::string, Warning> warnings_;     // by message
};

}  // namespace microtrace::io::gltf
