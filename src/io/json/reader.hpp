#pragma once
/// Typed reading of a JSON document: each value knows its pointer, and each complaint its place.

#include "io/json/document.hpp"
#include "scene/validate.hpp"

#include <microtrace/error.hpp>
#include <microtrace/math.hpp>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace microtrace::io {

/// One value of a document, which must outlive it. All functions that read throw Error
/// (invalid_scene) at the value if it is not what they say.
class JsonReader {
 public:
  /// The root.
  explicit JsonReader(const JsonDocument& document)
      : document_(&document), value_(&document.root()) {}

  [[nodiscard]] const JsonValue& value() const { return *value_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }

  /// An object with none but these members; an unknown one brings the nearest known to mind.
  void require_object(std::initializer_list<std::string_view> known) const;
  void require_object() const;
  /// The member of an object; `member` throws at the object if it is missing.
  [[nodiscard]] JsonReader member(std::string_view key) const;
  [[nodiscard]] std::optional<JsonReader> find(std::string_view key) const;
  /// All members with their keys.
  [[nodiscard]] std::vector<std::pair<std::string, JsonReader>> members() const;

  /// The items of an array; of `count` items if that is given.
  [[nodiscard]] std::vector<JsonReader> items(std::optional<std::size_t> count = {}) const;

  [[nodiscard]] std::string string() const;
  /// A string that is not empty.
  [[nodiscard]] std::string name() const;
  /// A number that is finite in float32.
  [[nodiscard]] double number() const;
  [[nodiscard]] float float32() const { return static_cast<float>(number()); }
  /// A number without fraction from 0 to 2^53.
  [[nodiscard]] std::uint64_t count() const;
  [[nodiscard]] DVec3 vector() const;
  [[nodiscard]] Vec3 vector32() const { return Vec3(vector()); }

  [[noreturn]] void fail(std::string message, ErrorKind kind = ErrorKind::invalid_scene) const;
  /// The complaint about a name, found in this value, that is not among the known.
  [[noreturn]] void fail_unknown(std::string_view what, std::string_view name,
                                 const std::vector<std::string_view>& known) const;
  /// Throws if a rule is broken: at the member that it names, or at this value if it is absent.
  void require(const std::optional<BrokenRule>& rule) const;

 private:
  JsonReader(const JsonDocument& document, const JsonValue& value, std::string pointer)
      : document_(&document), value_(&value), pointer_(std::move(pointer)) {}

  void require_kind(JsonValue::Kind kind) const;

  const JsonDocument* document_;
  const JsonValue* value_;
  std::string pointer_;
};

}  // namespace microtrace::io
