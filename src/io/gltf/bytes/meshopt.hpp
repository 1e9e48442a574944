#pragma once
/// EXT_meshopt_compression.

#include "io/gltf/bytes/buffers.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::io::gltf {

inline constexpr const char* meshopt_extension = "EXT_meshopt_compression";

/// The bytes of a buffer view that is compressed; nothing for another, and where its compressed
/// bytes have no data. `left` is how many bytes may be made, and becomes less by them. Throws
/// Error: invalid_scene, limit, unsupported where there is no module to do it and the asset
/// requires it (else a warning, and nothing).
[[nodiscard]] std::optional<std::string> decode_meshopt(Asset& asset, const Model& model,
                                                        std::size_t view,
                                                        const std::vector<Buffer>& buffers,
                                                        std::size_t& left);

}  // namespace microtrace::io::gltf
