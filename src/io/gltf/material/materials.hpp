#pragma once
/// Reads the materials of an asset.

#include "io/json/document.hpp"

#include <microtrace/material.hpp>

#include <cstdint>
#include <vector>

namespace microtrace::io::gltf {

/// Treatment of layers that are invisible because their factor is 0, and of their textures.
enum class UnusedLayers { left_out, kept };

/// Returns the materials of `root` in file order, followed by the default material, which
/// primitives without a material use (glTF 2.0, section 3.9.7).
[[nodiscard]] std::vector<Material> make_materials(const JsonValue& root,
                                                   UnusedLayers unused = UnusedLayers::left_out);

/// Appends an unlit copy of each of the materials `originals`.
void add_unlit_copies(std::vector<Material>& materials,
                      const std::vector<std::uint32_t>& originals);

}  // namespace microtrace::io::gltf
