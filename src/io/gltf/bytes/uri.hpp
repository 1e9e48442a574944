#pragma once
/// The two kinds of URI in glTF: data embedded in the JSON, and a file beside it.

#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io::gltf {

/// A data URI (RFC 2397).
struct DataUri {
  std::string_view media_type;  ///< without parameters
  bool is_base64 = false;       ///< otherwise the data is percent-encoded
  std::string_view data;        ///< still encoded
};

[[nodiscard]] bool is_data_uri(std::string_view uri);

/// Nothing if the URI has no comma or an empty parameter.
[[nodiscard]] std::optional<DataUri> split_data_uri(std::string_view uri);

/// Decodes padded base64 (RFC 4648, section 4). Nothing if the text is not base64.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text);

/// Decodes percent-encoding. Nothing if two hexadecimal digits don't follow a %.
[[nodiscard]] std::optional<std::string> decode_percent(std::string_view text);

/// A path made from a file URI, or the reason for refusing it.
struct RelativePath {
  std::string path{};      ///< percent-decoded; without "." and ".." unless refused
  std::string refusal{};   ///< empty if the path is accepted
  bool leads_out = false;  ///< refused only because it leaves, or may leave, the folder
};

/// Accepts relative paths (RFC 3986, section 4.2, path-noscheme) that stay in the asset's folder
/// after "." and ".." are resolved by name, and that contain no backslash or control character,
/// even percent-encoded.
[[nodiscard]] RelativePath relative_path(std::string_view uri);

}  // namespace microtrace::io::gltf
