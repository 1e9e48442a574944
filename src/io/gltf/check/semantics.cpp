#include "io/gltf/check/semantics.hpp"

namespace microtrace::io::gltf {

void check_semantics(Asset& asset) {
  check_storage(asset);
  check_cameras(asset);
  check_lights(asset);
  AccessorHeads accessors(asset);
  check_images(asset, accessors);
  check_materials(asset);
  check_meshes(asset, accessors);
  const NodeForest forest(asset);
  check_nodes(asset, forest);
  check_skins(asset, accessors, forest);
  check_animations(asset, accessors);
}

}  // namespace microtrace::io::gltf
