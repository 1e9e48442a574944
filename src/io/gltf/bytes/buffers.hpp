#pragma once
/// The bytes of an asset's buffers.

#include "io/gltf/bytes/resource.hpp"
#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

/// All buffers of an asset together, and each file they come from, hold at most so many bytes.
inline constexpr std::size_t max_buffer_bytes = std::size_t{1} << 32;

struct Buffer {
  std::string storage;                    ///< of bytes that did not come with the file
  std::optional<std::string_view> bytes;  ///< byteLength of them; nothing for a buffer that has
                                          ///< neither URI nor BIN chunk: extensions fill such
};

/// Reads the buffers that check_schema has accepted: a GLB file's `bin`, data URIs, files within
/// `folders`. Warns of one that has none of these. Throws Error with the buffer's pointer:
/// invalid_scene for a bad URI or too few bytes, io for a file, limit.
[[nodiscard]] std::vector<Buffer> load_buffers(Asset& asset, std::optional<std::string_view> bin,
                                               bool is_glb, const ResourceFolders& folders);

}  // namespace microtrace::io::gltf
