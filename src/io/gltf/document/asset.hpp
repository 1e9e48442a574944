#pragma once
/// The JSON of one glTF asset, with its warnings and errors.

#include "io/json/document.hpp"

#include <microtrace/error.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace microtrace::io::gltf {

/// A value in the asset's JSON, with its pointer.
struct Element {
  const JsonValue* value;
  std::string pointer;

  /// The member with that key; this element with the member's pointer if it is absent.
  [[nodiscard]] Element member(std::string_view key) const;
  /// The item at that index; likewise.
  [[nodiscard]] Element item(std::size_t index) const;
};

class Asset {
 public:
  /// The document must outlive the asset. Only drop and set modify it. Warns of duplicate keys.
  explicit Asset(JsonDocument& json);

  [[nodiscard]] Element root() const { return {&json_.root(), {}}; }
  [[nodiscard]] const std::string& file() const { return json_.file(); }

  /// The items of an array in the root object; none if it is absent.
  [[nodiscard]] const std::vector<JsonValue>& array(std::string_view name) const;
  /// Item `index` of that array, which must exist.
  [[nodiscard]] Element element(std::string_view name, std::size_t index) const;

  /// The value that a JSON pointer names, or null.
  [[nodiscard]] const JsonValue* find(std::string_view pointer) const;
  /// True if extensionsUsed contains the extension.
  [[nodiscard]] bool uses(std::string_view extension) const;
  /// True if extensionsRequired contains the extension.
  [[nodiscard]] bool requires_extension(std::string_view extension) const;

  /// Removes invalid members of an object from the asset's JSON, so that no reader sees them. The
  /// caller warns first. Invalidates Elements within the object.
  void drop(const Element& object, const std::unordered_set<std::string_view>& keys);
  /// Replaces a number. The caller warns first.
  void set(const Element& at, double number);

  [[noreturn]] void fail(const Element& at, std::string message,
                         ErrorKind kind = ErrorKind::invalid_scene) const;

  /// Adds a warning. Warnings with the same text become one, with the first place in the file and
  /// the number of places.
  void warn(const Element& at, const std::string& message);
  /// Reports a violation of glTF 2.0 that doesn't prevent rendering: a warning when rendering, an
  /// error when validating.
  void tolerate(const Element& at, const std::string& message);
  /// All warnings in file order. Beyond 100 different texts, a last one counts those left out.
  [[nodiscard]] std::vector<Diagnostic> warnings() const;

 private:
  struct Warning {
    std::size_t offset = 0, count = 0;
    std::string pointer;
    Severity severity = Severity::warning;
  };

  /// `at` is the first of `places` places.
  void note(const Element& at, const std::string& message, Severity severity, std::size_t places);

  JsonDocument& json_;
  std::unordered_set<std::string_view> used_, required_;  // extension names
  std::unordered_map<std::string, Warning> warnings_;     // by message
};

}  // namespace microtrace::io::gltf
