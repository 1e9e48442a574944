#pragma once
/// Reads the data to which an asset's URIs refer.

#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::io::gltf {

/// Decodes a data URI. Throws Error (invalid_scene).
[[nodiscard]] std::string decode_data_uri(const Asset& asset, const Element& uri);

/// The folders from which an asset may load files.
struct ResourceFolders {
  std::filesystem::path own;  ///< the asset's own folder, to which URIs are relative
  std::vector<std::filesystem::path> allowed;  ///< other folders in which URIs may name files
};

/// Reads a file in one of the folders or below. `what` names the kind of file in error messages,
/// for example "buffer". Throws Error: invalid_scene for a rejected URI, io, and limit for a file
/// larger than `max_bytes`.
[[nodiscard]] std::string read_resource(const Asset& asset, const Element& uri,
                                        const ResourceFolders& folders, const char* what,
                                        std::size_t max_bytes);

/// Why a file may not be read.
struct Refusal {
  std::string reason;
  bool is_violation;  ///< of glTF 2.0
};

/// Returns why the file that a URI names may not be read; nothing if it may.
[[nodiscard]] std::optional<Refusal> refusal_of(const Element& uri, const ResourceFolders& folders);

/// True if a URI names a file that may be read but does not exist.
[[nodiscard]] bool is_missing_resource(const Element& uri, const ResourceFolders& folders);

/// Warns if a % in the name of a file is not percent-encoding.
void tolerate_stray_percent(Asset& asset, const Element& uri);

/// Records a file that a URI names but that is not read, so that outputs don't overwrite this file
/// either.
void note_unread_resource(const Element& uri, const ResourceFolders& folders);

}  // namespace microtrace::io::gltf
