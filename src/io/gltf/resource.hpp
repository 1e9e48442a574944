#pragma once
/// The bytes that URIs of an asset stand for.

#include "io/gltf/asset.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace microtrace::io::gltf {

/// The data of a data URI. Throws Error (invalid_scene).
[[nodiscard]] std::string decode_data_uri(const Asset& asset, const Element& uri);

/// A file in the asset's folder or below, of at most so many bytes. `what` it is stands in
/// messages: "buffer". Throws Error: invalid_scene for a URI that is refused, io, limit.
[[nodiscard]] std::string read_resource(const Asset& asset, const Element& uri,
                                        const std::filesystem::path& folder, const char* what,
                                        std::size_t max_bytes);

}  // namespace microtrace::io::gltf
