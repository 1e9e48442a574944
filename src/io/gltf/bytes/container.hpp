#pragma once
/// The two containers of glTF: a JSON text, or a GLB file, which is binary and contains JSON and
/// one buffer.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io::gltf {

struct Container {
  std::string_view json;
  std::optional<std::string_view> bin;  ///< BIN chunk of a GLB file, if it has one
  bool is_glb = false;
  bool is_aligned = true;            ///< all chunk lengths are multiples of 4, as glTF requires
  bool has_byte_order_mark = false;  ///< before the JSON (glTF 2.0, section 2.7, forbids it)
  bool has_zero_padding = false;     ///< the JSON chunk ends with zero bytes instead of spaces
  std::size_t extra_bytes = 0;       ///< number of bytes after the end that the GLB header states
};

/// Splits a file into its parts without copying (glTF 2.0, section 4, GLB file format). Skips
/// chunks of unknown types. Throws Error: invalid_scene for malformed chunks, unsupported for
/// another container version. Error messages name the file `name`.
[[nodiscard]] Container open_container(std::string_view bytes, const std::string& name);

}  // namespace microtrace::io::gltf
