#pragma once
/// The JSON of one glTF asset, and all that is said about it to the user.

#include "io/json/document.hpp"

#include <microtrace/error.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace microtrace::io::gltf {

/// A value of the asset's JSON and where it stands.
struct Element {
  const JsonValue* value;
  std::string pointer;

  /// The member of that name; the element itself, with the member's pointer, where it has none.
  [[nodiscard]] Element member(std::string_view key) const;
  /// The item of that number; as above.
  [[nodiscard]] Element item(std::size_t index) const;
};

class Asset {
 public:
  /// The document must outlive the asset, which changes it by drop and set alone. Warns of keys
  /// that stand twice in an object.
  explicit Asset(JsonDocument& json);

  [[nodiscard]] Element root() const { return {&json_.root(), {}}; }
  [[nodiscard]] const std::string& file() const { return json_.file(); }

  /// The items of an array of the root object, by its name; none where it is absent.
  [[nodiscard]] const std::vector<JsonValue>& array(std::string_view name) const;
  /// Item `index` of that array, which has it.
  [[nodiscard]] Element element(std::string_view name, std::size_t index) const;

  /// The value that a JSON pointer leads to, or null.
  [[nodiscard]] const JsonValue* find(std::string_view pointer) const;
  /// Whether extensionsUsed names that extension.
  [[nodiscard]] bool uses(std::string_view extension) const;
  /// Whether extensionsRequired names it.
  [[nodiscard]] bool requires_extension(std::string_view extension) const;

  /// Takes members that do no good out of an object of the asset's JSON, after a warning. What is
  /// left is what readers see. Elements in the object are no longer good.
  void drop(const Element& object, const std::unordered_set<std::string_view>& keys);
  /// Puts another number in the place of one, after a warning.
  void set(const Element& at, double number);

  [[noreturn]] void fail(const Element& at, std::string message,
                         ErrorKind kind = ErrorKind::invalid_scene) const;

  /// Warnings with one text become one diagnostic: the first place in the file, and their number.
  void warn(const Element& at, const std::string& message);
  /// The same for a rule of glTF 2.0 that is broken there without keeping the asset from being
  /// drawn: a warning for those who draw it, an error for those who validate it.
  void tolerate(const Element& at, const std::string& message);
  /// All warnings in file order; beyond 100 texts, a last one says how many are left out.
  [[nodiscard]] std::vector<Diagnostic> warnings() const;

 private:
  struct Warning {
    std::size_t offset = 0, count = 0;
    std::string pointer;
    Severity severity = Severity::warning;
  };

  /// `at` is the first of so many places.
  void note(const Element& at, const std::string& message, Severity severity, std::size_t places);

  JsonDocument& json_;
  std::unordered_set<std::string_view> used_, required_;  // extensions
  std::unordered_map<std::string, Warning> warnings_;     // by text
};

}  // namespace microtrace::io::gltf
