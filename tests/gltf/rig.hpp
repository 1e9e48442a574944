#pragma once
/// An asset with almost every kind of object. Tests break one object at a time.

#include "gltf/asset_builder.hpp"

namespace microtrace::tests {

/// The accessors of rig(), by number.
enum RigAccessor : std::size_t {
  rig_positions,
  rig_normals,
  rig_tangents,
  rig_texcoords,
  rig_colors,
  rig_joints,
  rig_weights,
  rig_displacements,
  rig_indices,
  rig_matrices,
  rig_times,
  rig_translations,
  rig_rotations,
  rig_morph_weights,
};

/// Returns a triangle with all standard attributes, a morph target, a skin of two joints, an
/// animation of three channels, a textured material, a spot light and two variants. Nodes: 0 has
/// the mesh, 1 and 2 are the joints, 2 is a child of 1, and 3 has the light. Each accessor has the
/// view with its own number. The last view contains the image.
[[nodiscard]] AssetBuilder rig();

/// Overwrites a value in the rig's accessor `accessor`. `number` counts values of this type.
template <typename Number>
void poke(AssetBuilder& asset, std::size_t accessor, std::size_t number, Number value) {
  const std::size_t offset =
      asset.json["bufferViews"][accessor]["byteOffset"].to_size() + number * sizeof value;
  asset.buffer.replace(offset, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace microtrace::tests
