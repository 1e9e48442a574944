#pragma once
/// An asset with almost every kind of object, for breaking one at a time.

#include "gltf/asset_builder.hpp"

namespace microtrace::tests {

/// A triangle with all standard attributes, a morph target, a skin of two joints, an animation of
/// three channels, a textured material, a spot light and two variants. Its accessors:
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

/// Its nodes: 0 the mesh, 1 and 2 the joints, 2 a child of 1, 3 the light. The view of an accessor
/// has the accessor's number; the last view is the image's.
[[nodiscard]] AssetBuilder rig();

/// Overwrites element `number` of an accessor of the rig.
template <typename Number>
void poke(AssetBuilder& asset, std::size_t accessor, std::size_t number, Number value) {
  const std::size_t offset =
      asset.json["bufferViews"][accessor]["byteOffset"].to_size() + number * sizeof value;
  asset.buffer.replace(offset, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace microtrace::tests
