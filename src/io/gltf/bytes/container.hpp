#pragma once
/// The two ways in which a glTF asset comes: JSON alone, or JSON and a buffer in one binary file.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io::gltf {

struct Container {
  std::string_view json;
  std::optional<std::string_view> bin;  ///< of a GLB file that has a BIN chunk
  bool is_glb = false;
  bool is_aligned = true;       ///< the lengths of all chunks are multiples of 4, as they must be
  std::size_t extra_bytes = 0;  ///< in the file after the end that a GLB header names
};

/// Takes a file apart without copying it (glTF 2.0, section 4, GLB file format). Chunks of unknown
/// types are skipped. Throws Error: invalid_scene where the chunks are not as the format asks,
/// unsupported for another container version. `name` stands in messages.
[[nodiscard]] Container open_container(std::string_view bytes, const std::string& name);

}  // namespace microtrace::io::gltf
