#pragma once
/// A JSON text with the position of every value, so that errors can name file, line, column and
/// pointer.

#include <microtrace/error.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io {

inline constexpr std::size_t kMaxJsonDepth = 256;                    ///< maximum nesting
inline constexpr std::size_t kMaxJsonSize = std::size_t{1} << 30;    ///< bytes
inline constexpr std::size_t kMaxJsonValues = std::size_t{1} << 24;  ///< total number of values

struct JsonMember;

struct JsonValue {
  enum class Kind { null, boolean, number, string, array, object };

  Kind kind = Kind::null;
  bool boolean = false;
  bool is_integer = false;  ///< number written without fraction or exponent and within +-2^53
  double number = 0;        ///< always finite
  std::string string;
  std::vector<JsonValue> items;     ///< elements of an array
  std::vector<JsonMember> members;  ///< of an object, in file order, keys unique
  std::size_t offset = 0;           ///< byte offset of the value
  std::size_t key_offset = 0;       ///< byte offset of its key, in an object

  /// The member with this name, or null.
  [[nodiscard]] const JsonValue* find(std::string_view key) const;
  [[nodiscard]] JsonValue* find(std::string_view key);

  /// Must be called after adding or removing members, because find() uses an index.
  void index_members();

 private:
  /// The index of the member with this name, or the number of members.
  [[nodiscard]] std::size_t position(std::string_view key) const;

  /// The indices of the members sorted by key, if there are many.
  std::shared_ptr<const std::vector<std::uint32_t>> by_key_{};
};

struct JsonMember {
  std::string key;
  JsonValue value;
};

/// The handling of duplicate keys in an object.
enum class RepeatedKeys { are_refused, last_counts };

/// The duplicate keys of a document.
struct OutdoneKeys {
  std::size_t count = 0;
  std::size_t offset = 0;  ///< byte offset of the first one
  std::string pointer{};   ///< to its object and key
};

class JsonDocument {
 public:
  /// Parses a whole text (RFC 8259); a leading UTF-8 byte order mark is skipped. Throws Error
  /// (invalid_scene; limit if one of the maxima above is exceeded) with line, column and excerpt if
  /// the text is not JSON, not UTF-8, has a number beyond the range of double, or a duplicate key
  /// in an object.
  JsonDocument(std::string_view text, std::string file, std::size_t max_values = kMaxJsonValues,
               RepeatedKeys repeated = RepeatedKeys::are_refused);

  [[nodiscard]] const JsonValue& root() const { return root_; }
  [[nodiscard]] JsonValue& root() { return root_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  /// Keys that were replaced by later ones with the same name.
  [[nodiscard]] const OutdoneKeys& outdone_keys() const { return outdone_keys_; }

  /// A message about the byte at `offset` of the text, with line, column and caret. Control
  /// characters in the pointer are escaped as \x1b.
  [[nodiscard]] Diagnostic at(std::size_t offset, const std::string& pointer,
                              std::string message) const;

 private:
  std::string_view text_;  // the caller's; must outlive the document
  std::string file_;
  JsonValue root_;
  OutdoneKeys outdone_keys_;
};

/// Appends one reference token to a JSON pointer, escaped according to RFC 6901.
[[nodiscard]] std::string child(const std::string& pointer, std::string_view key);
[[nodiscard]] std::string child(const std::string& pointer, std::size_t index);

/// The unescaped reference tokens of a JSON pointer; nothing if it is malformed.
[[nodiscard]] std::optional<std::vector<std::string>> pointer_tokens(std::string_view pointer);

/// The value that a JSON pointer names, or null.
[[nodiscard]] const JsonValue* resolve(const JsonValue& root, std::string_view pointer);
[[nodiscard]] JsonValue* resolve(JsonValue& root, std::string_view pointer);

}  // namespace microtrace::io
