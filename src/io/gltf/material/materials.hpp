#pragma once
/// Materials of an asset.

#include "io/json/document.hpp"

#include <microtrace/material.hpp>

#include <cstdint>
#include <vector>

namespace microtrace::io::gltf {

/// Handling of layers that a factor of 0 makes invisible, and of their textures.
enum class UnusedLayers { left_out, kept };

/// The root object's materials in file order, followed by the default material of primitives
/// without one (glTF 2.0, section 3.9.7).
[[nodiscard]] std::vector<Material> make_materials(const JsonValue& root,
                                                   UnusedLayers unused = UnusedLayers::left_out);

/// Appends unlit copies of these materials.
void add_unlit_copies(std::vector<Material>& materials,
                      const std::vector<std::uint32_t>& originals);

}  // namespace microtrace::io::gltf
