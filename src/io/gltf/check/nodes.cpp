#include "io/gltf/check/semantics.hpp"
#include "io/gltf/document/properties.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace microtrace::io::gltf {
namespace {

/// Properties of a mesh that restrict the nodes that use it.
struct MeshParts {
  std::size_t targets = 0;
  bool has_joints = false;  ///< true if every primitive has joints
};

std::vector<MeshParts> mesh_parts(const Asset& asset) {
  std::vector<MeshParts> result;
  for (const JsonValue& mesh : asset.array("meshes")) {
    const std::vector<JsonValue>& primitives = mesh.find("primitives")->items();
    MeshParts parts;
    parts.targets = morph_target_count(mesh);
    parts.has_joints = std::ranges::all_of(primitives, [](const JsonValue& primitive) {
      return primitive.find("attributes")->find("JOINTS_0") != nullptr;
    });
    result.push_back(parts);
  }
  return result;
}

void check_matrix(Asset& asset, const Element& at) {
  for (const char* other : {"translation", "rotation", "scale"}) {
    if (at.value->find(other) != nullptr) {
      asset.tolerate(at.member(other), "must not be combined with a matrix; it is ignored");
      asset.drop(at, {other});
    }
  }
  const Element matrix = at.member("matrix");
  const auto item = [&](std::size_t i) { return matrix.value->items()[i].number(); };
  if (item(3) != 0 || item(7) != 0 || item(11) != 0 || item(15) != 1) {
    asset.tolerate(matrix,
                   "is not affine: items 3, 7, 11, 15 must be 0, 0, 0, 1; these values are used");
  }
  const auto dot = [&](std::size_t a, std::size_t b) {
    return item(a) * item(b) + item(a + 1) * item(b + 1) + item(a + 2) * item(b + 2);
  };
  for (const auto& [a, b] : {std::pair{0, 4}, std::pair{0, 8}, std::pair{4, 8}}) {
    const auto i = static_cast<std::size_t>(a), k = static_cast<std::size_t>(b);
    const double cosine = dot(i, k) / std::sqrt(dot(i, i) * dot(k, k));
    if (!(std::abs(cosine) <= 1e-3)) {
      asset.tolerate(matrix,
                     "is not a product of translation, rotation and scale, as glTF 2.0 requires");
      return;
    }
  }
}

void check_rotation(Asset& asset, const Element& at) {
  double square = 0;
  for (const JsonValue& item : at.value->items()) square += item.number() * item.number();
  if (square == 0) {
    asset.tolerate(at, "must be a unit quaternion, is zero; it is ignored");
    return asset.set(at.item(3), 1);
  }
  if (std::abs(square - 1) > 1e-3) asset.tolerate(at, "is not a unit quaternion; it is normalized");
}

void check_mesh(Asset& asset, const Element& at, const std::vector<MeshParts>& meshes) {
  const JsonValue* mesh = at.value->find("mesh");
  const bool has_skin = at.value->find("skin") != nullptr;
  if (mesh == nullptr) {
    if (has_skin) asset.tolerate(at.member("skin"), "has no effect: the node has no mesh");
    if (at.value->find("weights") == nullptr) return;
    asset.tolerate(at.member("weights"), "have no effect: the node has no mesh");
    return asset.drop(at, {"weights"});
  }
  const MeshParts& parts = meshes[index_from(*mesh)];
  if (has_skin && !parts.has_joints) {
    asset.tolerate(at.member("skin"), "applies to a mesh with a primitive that has no JOINTS_0");
  }
  check_weights(asset, at, parts.targets);
}

/// Drops a reference to a camera whose type check_schema does not know.
void drop_unknown_camera(Asset& asset, const Element& at) {
  const JsonValue* index = at.value->find("camera");
  if (index == nullptr) return;
  const JsonValue& camera = asset.array("cameras")[index_from(*index)];
  if (camera.find("type") == nullptr) asset.drop(at, {"camera"});
}

}  // namespace

void check_weights(Asset& asset, const Element& at, std::size_t targets) {
  const JsonValue* weights = at.value->find("weights");
  if (weights == nullptr || weights->items().size() == targets) return;
  asset.tolerate(at.member("weights"), "has " + std::to_string(weights->items().size()) +
                                           " items for " + std::to_string(targets) +
                                           " morph targets; they are ignored");
  asset.drop(at, {"weights"});
}

void check_nodes(Asset& asset, const NodeForest& forest) {
  const std::vector<MeshParts> meshes = mesh_parts(asset);
  for (std::size_t i = 0; i < asset.array("nodes").size(); ++i) {
    const Element at = asset.element("nodes", i);
    if (at.value->find("matrix") != nullptr) check_matrix(asset, at);
    if (at.value->find("rotation") != nullptr) check_rotation(asset, at.member("rotation"));
    check_mesh(asset, at, meshes);
    drop_unknown_camera(asset, at);
  }
  for (std::size_t i = 0; i < asset.array("scenes").size(); ++i) {
    const Element nodes = asset.element("scenes", i).member("nodes");
    for (std::size_t k = 0; k < nodes.value->items().size(); ++k) {
      const Element node = nodes.item(k);
      if (const auto parent = forest.parent(index_from(*node.value))) {
        asset.tolerate(node, "is a child of node " + std::to_string(*parent) +
                                 "; scenes must list root nodes only");
      }
    }
  }
}

}  // namespace microtrace::io::gltf
