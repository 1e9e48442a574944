#pragma once
/// Loads buffers.

#include "io/gltf/bytes/resource.hpp"
#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

/// The maximum number of bytes of all buffers together, and of each file with buffer data.
inline constexpr std::size_t kMaxBufferBytes = std::size_t{1} << 32;

struct Buffer {
  std::string storage;  ///< data that is not part of the asset's file
  /// The first byteLength bytes. Nothing if an extension must supply the data.
  std::optional<std::string_view> bytes;
};

/// Loads buffers from the GLB file's `bin`, from data URIs and from files in `folders`. Expects
/// buffers that check_schema has accepted. Skips the fallback buffers of compressed views if
/// the views can be decoded. Warns about a buffer without any of these sources.
/// Throws Error with the buffer's pointer: invalid_scene for a bad URI or too few bytes, io for a
/// file, limit.
[[nodiscard]] std::vector<Buffer> load_buffers(Asset& asset, std::optional<std::string_view> bin,
                                               bool is_glb, const ResourceFolders& folders);

}  // namespace microtrace::io::gltf
