#pragma once
/// The bytes that URIs of an asset stand for.

#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace microtrace::io::gltf {

/// The data of a data URI. Throws Error (invalid_scene).
[[nodiscard]] std::string decode_data_uri(const Asset& asset, const Element& uri);

/// Where an asset's files may lie.
struct ResourceFolders {
  std::filesystem::path own;                   ///< the asset's: URIs are relative to it
  std::vector<std::filesystem::path> allowed;  ///< others that URIs may lead to
};

/// A file in one of the folders or below, of at most so many bytes. `what` it is stands in
/// messages: "buffer". Throws Error: invalid_scene for a URI that is refused, io, limit.
[[nodiscard]] std::string read_resource(const Asset& asset, const Element& uri,
                                        const ResourceFolders& folders, const char* what,
                                        std::size_t max_bytes);

/// Notes the file of a URI that is not read, lest it is written over.
void note_unread_resource(const Element& uri, const ResourceFolders& folders);

}  // namespace microtrace::io::gltf
