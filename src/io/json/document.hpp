#pragma once
/// A JSON text with the place of every value, so that any later complaint can name file, line,
/// column and pointer.

#include <microtrace/error.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io {

inline constexpr std::size_t max_json_depth = 256;                    ///< of nested values
inline constexpr std::size_t max_json_size = std::size_t{1} << 30;    ///< bytes
inline constexpr std::size_t max_json_values = std::size_t{1} << 24;  ///< of all kinds together

struct JsonMember;

struct JsonValue {
  enum class Kind { null, boolean, number, string, array, object };

  Kind kind = Kind::null;
  bool boolean = false;
  bool is_integer = false;  ///< number written without fraction or exponent and within +-2^53
  double number = 0;        ///< always finite
  std::string string;
  std::vector<JsonValue> items;     ///< of an array
  std::vector<JsonMember> members;  ///< of an object, in file order, keys unique
  std::size_t offset = 0;           ///< byte at which the value starts
  std::size_t key_offset = 0;       ///< byte at which its key starts, in an object

  /// The member of that name, or null.
  [[nodiscard]] const JsonValue* find(std::string_view key) const;
  [[nodiscard]] JsonValue* find(std::string_view key);

  /// To be called where members were added or taken away: find() looks them up by an index.
  void index_members();

 private:
  /// The number of the member of that name, or that of members.
  [[nodiscard]] std::size_t position(std::string_view key) const;

  /// The numbers of the members in the order of their keys, where they are many.
  std::shared_ptr<const std::vector<std::uint32_t>> by_key_{};
};

struct JsonMember {
  std::string key;
  JsonValue value;
};

/// What is done about a key that stands twice in one object.
enum class RepeatedKeys { are_refused, last_counts };

/// All such keys of a document.
struct OutdoneKeys {
  std::size_t count = 0;
  std::size_t offset = 0;  ///< where the first one in the text stands
  std::string pointer{};   ///< to it and to the one that counts
};

class JsonDocument {
 public:
  /// Parses a whole text (RFC 8259); a UTF-8 byte order mark before it is skipped. Throws Error
  /// (invalid_scene; limit where one of the maxima above is exceeded) with line, column and excerpt
  /// for: not JSON, not UTF-8, a number beyond double's range, a key twice in an object.
  JsonDocument(std::string_view text, std::string file, std::size_t max_values = max_json_values,
               RepeatedKeys repeated = RepeatedKeys::are_refused);

  [[nodiscard]] const JsonValue& root() const { return root_; }
  [[nodiscard]] JsonValue& root() { return root_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  /// Keys of objects whose place a later one of the same name has taken.
  [[nodiscard]] const OutdoneKeys& outdone_keys() const { return outdone_keys_; }

  /// A message about the byte at `offset` of the text, with line, column and caret. Control
  /// characters in the pointer are shown as \x1b.
  [[nodiscard]] Diagnostic at(std::size_t offset, const std::string& pointer,
                              std::string message) const;

 private:
  std::string_view text_;  // the caller's; outlives the document
  std::string file_;
  JsonValue root_;
  OutdoneKeys outdone_keys_;
};

/// Appends one reference token to a JSON pointer, escaped as RFC 6901 says.
[[nodiscard]] std::string child(const std::string& pointer, std::string_view key);
[[nodiscard]] std::string child(const std::string& pointer, std::size_t index);

/// The reference tokens of a JSON pointer, unescaped; nothing where it is not well-formed.
[[nodiscard]] std::optional<std::vector<std::string>> pointer_tokens(std::string_view pointer);

/// The value that a JSON pointer leads to, or null.
[[nodiscard]] const JsonValue* resolve(const JsonValue& root, std::string_view pointer);
[[nodiscard]] JsonValue* resolve(JsonValue& root, std::string_view pointer);

}  // namespace microtrace::io
