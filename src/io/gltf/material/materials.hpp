#pragma once
/// The materials of an asset.

#include "io/json/document.hpp"

#include <microtrace/material.hpp>

#include <cstdint>
#include <vector>

namespace microtrace::io::gltf {

/// Layers that a factor of 0 makes invisible, with their textures.
enum class UnusedLayers { left_out, kept };

/// All materials of the root object in file order, and after them the one of primitives that name
/// none (glTF 2.0, section 3.9.7).
[[nodiscard]] std::vector<Material> make_materials(const JsonValue& root,
                                                   UnusedLayers unused = UnusedLayers::left_out);

/// Appends a copy of each of these materials that light does not change.
void add_unlit_copies(std::vector<Material>& materials,
                      const std::vector<std::uint32_t>& originals);

}  // namespace microtrace::io::gltf
