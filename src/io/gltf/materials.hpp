#pragma once
/// The materials of an asset.

#include "io/gltf/asset.hpp"

#include <microtrace/material.hpp>

#include <vector>

namespace microtrace::io::gltf {

/// All materials in file order, and after them the one of primitives that name none (glTF 2.0,
/// section 3.9.7).
[[nodiscard]] std::vector<Material> make_materials(const Asset& asset);

}  // namespace microtrace::io::gltf
