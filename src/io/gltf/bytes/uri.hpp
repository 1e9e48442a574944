#pragma once
/// The two kinds of URI that a buffer may have: data within the JSON, and a file beside it.

#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io::gltf {

/// A data URI (RFC 2397).
struct DataUri {
  std::string_view media_type;  ///< without its parameters
  bool is_base64 = false;       ///< else the data is percent-encoded
  std::string_view data;        ///< as it stands in the URI
};

[[nodiscard]] bool is_data_uri(std::string_view uri);

/// Nothing where the URI has no comma or an empty parameter.
[[nodiscard]] std::optional<DataUri> split_data_uri(std::string_view uri);

/// The bytes (RFC 4648, section 4, padded); nothing where the text is not base64.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text);

/// Nothing where a % lacks its two hexadecimal digits.
[[nodiscard]] std::optional<std::string> decode_percent(std::string_view text);

/// A file URI made into a path, or the reason why it is refused.
struct RelativePath {
  std::string path{};      ///< percent-decoded, without "." and ".." where it is good
  std::string refusal{};   ///< empty where the path is good
  bool leads_out = false;  ///< refused only because it leads, or may lead, out of the folder
};

/// Accepts relative paths only (RFC 3986, section 4.2, path-noscheme), without backslash and
/// control characters before and after percent-decoding, that lead nowhere but into the asset's
/// folder once
/// "." and ".." are resolved by name alone.
[[nodiscard]] RelativePath relative_path(std::string_view uri);

}  // namespace microtrace::io::gltf
