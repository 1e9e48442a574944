#pragma once
/// Reads JSON values of expected types. Each value knows its pointer, and each error states a
/// position.

#include "io/json/document.hpp"
#include "scene/validate/validate.hpp"

#include <microtrace/error.hpp>
#include <microtrace/math.hpp>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace microtrace::io {

/// One value of a document. The document must outlive this object. If the value does not have the
/// required form, all reading functions throw an Error (invalid_scene) that points to the value.
class JsonReader {
 public:
  /// Makes a reader of the root.
  explicit JsonReader(const JsonDocument& document)
      : document_(&document), value_(&document.root()) {}

  [[nodiscard]] const JsonValue& value() const { return *value_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }

  /// Requires an object that has only members with these names. The error for an unknown member
  /// suggests the most similar name.
  void require_object(std::initializer_list<std::string_view> known) const;
  void require_object() const;
  /// Returns the member with this key. If it is missing, `member` throws an error that points to
  /// the object.
  [[nodiscard]] JsonReader member(std::string_view key) const;
  [[nodiscard]] std::optional<JsonReader> find(std::string_view key) const;
  /// Returns all members with their keys.
  [[nodiscard]] std::vector<std::pair<std::string, JsonReader>> members() const;

  /// Returns the elements of an array. If `count` is given, there must be exactly this many.
  [[nodiscard]] std::vector<JsonReader> items(std::optional<std::size_t> count = {}) const;

  [[nodiscard]] std::string string() const;
  /// Reads a string that must not be empty.
  [[nodiscard]] std::string name() const;
  /// Reads a number that must be finite in float32.
  [[nodiscard]] double number() const;
  [[nodiscard]] float float32() const { return static_cast<float>(number()); }
  /// Reads an integer from 0 to 2^53.
  [[nodiscard]] std::uint64_t count() const;
  [[nodiscard]] DVec3 vector() const;
  [[nodiscard]] Vec3 vector32() const { return Vec3(vector()); }

  [[noreturn]] void fail(std::string message, ErrorKind kind = ErrorKind::invalid_scene) const;
  /// Throws an error of the kind of `cause`, which occurred in a file that this value names.
  [[noreturn]] void fail(std::string message, const Error& cause) const;
  /// Throws the error for an unknown name in this value. The error suggests the most similar known
  /// one.
  [[noreturn]] void fail_unknown(std::string_view what, std::string_view name,
                                 const std::vector<std::string_view>& known) const;
  /// If a rule is broken, throws an error that points to the named member, or to this value if the
  /// member is absent.
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
