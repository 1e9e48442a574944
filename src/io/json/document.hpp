#pragma once
/// A JSON text with the position of every value. Errors can therefore state file, line, column and
/// pointer.

#include "io/json/value.hpp"

#include <microtrace/error.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io {

inline constexpr std::size_t kMaxJsonDepth = 256;                  ///< maximum nesting depth
inline constexpr std::size_t kMaxJsonSize = std::size_t{1} << 30;  ///< maximum size in bytes
inline constexpr std::size_t kMaxJsonValues = std::size_t{1}
                                              << 26;  ///< maximum total number of values

/// The treatment of duplicate keys in an object.
enum class RepeatedKeys { are_refused, last_counts };

/// The duplicate keys of a document.
struct OutdoneKeys {
  std::size_t count = 0;
  std::size_t offset = 0;  ///< byte offset of the first duplicate key
  std::string pointer{};   ///< JSON pointer to this key's member
};

class JsonDocument {
 public:
  /// Parses a whole text (RFC 8259). Skips a leading UTF-8 byte order mark. Throws Error
  /// (invalid_scene) with line, column and excerpt if the text is not JSON, is not UTF-8, or has a
  /// number beyond the range of double or a duplicate key in an object. Throws Error (limit) if one
  /// of the maxima above is exceeded.
  JsonDocument(std::string_view text, std::string file, std::size_t max_values = kMaxJsonValues,
               RepeatedKeys repeated = RepeatedKeys::are_refused);

  [[nodiscard]] const JsonValue& root() const { return root_; }
  [[nodiscard]] JsonValue& root() { return root_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  /// Keys that were replaced by later ones with the same name.
  [[nodiscard]] const OutdoneKeys& outdone_keys() const { return outdone_keys_; }

  /// Makes a message about the byte at `offset`, with line, column, and a caret below the byte.
  /// Escapes control characters in the pointer, for example as \x1b.
  [[nodiscard]] Diagnostic at(std::size_t offset, const std::string& pointer,
                              std::string message) const;
  /// Throws an error of the kind of `cause` about the byte at `offset`, where the text names the
  /// file in which `cause` occurred.
  [[noreturn]] void fail(std::size_t offset, const std::string& pointer, std::string message,
                         const Error& cause) const;

 private:
  std::string_view text_;  // owned by the caller; must outlive the document
  std::string file_;
  JsonValue root_;
  OutdoneKeys outdone_keys_;
};

/// Appends one reference token to a JSON pointer and escapes it (RFC 6901).
[[nodiscard]] std::string child(const std::string& pointer, std::string_view key);
[[nodiscard]] std::string child(const std::string& pointer, std::size_t index);

/// Returns the unescaped reference tokens of a JSON pointer. Nothing if the pointer is malformed.
[[nodiscard]] std::optional<std::vector<std::string>> pointer_tokens(std::string_view pointer);

/// Returns the index of an array's item that a reference token names. Nothing unless it consists of
/// digits without leading zeros (RFC 6901, section 4).
[[nodiscard]] std::optional<std::size_t> array_index(std::string_view token);

/// The value that a JSON pointer names, or null.
[[nodiscard]] const JsonValue* resolve(const JsonValue& root, std::string_view pointer);
[[nodiscard]] JsonValue* resolve(JsonValue& root, std::string_view pointer);

}  // namespace microtrace::io
