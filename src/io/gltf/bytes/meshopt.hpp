#pragma once
/// Decodes EXT_meshopt_compression and KHR_meshopt_compression.

#include "io/gltf/bytes/buffers.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::io::gltf {

/// Returns true if the decoder module is available.
[[nodiscard]] bool can_decode_meshopt();

/// Decompresses a buffer view. Returns nothing for an uncompressed view, or if the compressed data
/// is absent. `left` is the remaining limit on decompressed bytes, which the call reduces. Without
/// the decoder module, throws Error (unsupported) if the asset requires the extension; otherwise
/// warns and returns nothing. Throws Error: invalid_scene, limit, unsupported.
[[nodiscard]] std::optional<std::string> decode_meshopt(Asset& asset, const Model& model,
                                                        std::size_t view,
                                                        const std::vector<Buffer>& buffers,
                                                        std::size_t& left);

}  // namespace microtrace::io::gltf
