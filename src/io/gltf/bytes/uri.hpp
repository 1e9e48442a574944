#pragma once
/// The two kinds of URI in glTF: embedded data, and a relative path of a file.

#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io::gltf {

/// A data URI (RFC 2397).
struct DataUri {
  /// The media type without parameters, in small letters: case has no meaning in it (RFC 2045,
  /// section 5.1).
  std::string media_type;
  bool is_base64 = false;  ///< if false, the data is percent-encoded
  std::string_view data;   ///< data, not yet decoded
};

[[nodiscard]] bool is_data_uri(std::string_view uri);

/// Splits a data URI. Returns nothing if the URI has no comma or an empty parameter.
[[nodiscard]] std::optional<DataUri> split_data_uri(std::string_view uri);

/// Decodes base64 (RFC 4648, section 4). The padding may be omitted, and white space is skipped, as
/// in browsers. Returns nothing if the text is not base64.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text);

/// Decodes percent-encoding. Returns nothing if a % is not followed by two hexadecimal digits.
[[nodiscard]] std::optional<std::string> decode_percent(std::string_view text);

/// A path made from a file URI, or the reason for rejecting it.
struct RelativePath {
  std::string path{};       ///< percent-decoded; contains "." and ".." only if rejected
  std::string refusal{};    ///< reason; empty if the path is accepted
  bool leads_out = false;   ///< rejected only because the path leaves, or may leave, the folder
  bool is_invalid = false;  ///< rejected because the text is no URI
  bool has_stray_percent = false;  ///< a % is not followed by two digits, so all % are literal
};

/// Accepts relative paths (RFC 3986, section 4.2, path-noscheme). After "." and ".." are resolved
/// by name, the path must stay in the asset's folder. It must not contain control characters, not
/// even percent-encoded. Backslashes separate folders as in Windows.
[[nodiscard]] RelativePath relative_path(std::string_view uri);

}  // namespace microtrace::io::gltf
