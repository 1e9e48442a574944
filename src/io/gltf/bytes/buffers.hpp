#pragma once
/// Loading of buffers.

#include "io/gltf/bytes/resource.hpp"
#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

/// Limit on the bytes of all buffers together and of each file that they come from.
inline constexpr std::size_t kMaxBufferBytes = std::size_t{1} << 32;

struct Buffer {
  std::string storage;                    ///< data that is not part of the asset's file
  std::optional<std::string_view> bytes;  ///< byteLength bytes; nothing if the buffer has neither
                                          ///< URI nor BIN chunk, for extensions to fill
};

/// Loads the buffers that check_schema has accepted from the GLB file's `bin`, data URIs and files
/// within `folders`. Warns of a buffer with none of these. Throws Error with the buffer's pointer:
/// invalid_scene for a bad URI or too few bytes, io for a file, limit.
[[nodiscard]] std::vector<Buffer> load_buffers(Asset& asset, std::optional<std::string_view> bin,
                                               bool is_glb, const ResourceFolders& folders);

}  // namespace microtrace::io::gltf
