#pragma once
/// Finds the objects of EXT_meshopt_compression and of its successor KHR_meshopt_compression. The
/// latter adds attributes of version 1 and the filter COLOR.

#include "io/gltf/document/asset.hpp"

#include <optional>
#include <string_view>

namespace microtrace::io::gltf {

inline constexpr std::string_view kExtMeshopt = "EXT_meshopt_compression";
inline constexpr std::string_view kKhrMeshopt = "KHR_meshopt_compression";

struct MeshoptObject {
  std::string_view extension{};  ///< one of the two names
  Element at;
};

/// Returns the object in a buffer or a buffer view, if any. If both extensions have one, that of
/// KHR_meshopt_compression.
[[nodiscard]] std::optional<MeshoptObject> meshopt_object(const Element& holder);

}  // namespace microtrace::io::gltf
