#include "io/gltf/check/semantics.hpp"
#include "io/gltf/document/element_types.hpp"
#include "io/gltf/document/properties.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace microtrace::io::gltf {
namespace {

void check_joints(Asset& asset, const Element& at, const NodeForest& forest) {
  const std::vector<JsonValue>& joints = at.member("joints").value->items();
  const auto has_other_root = [&](const JsonValue& joint) {
    return forest.root(index_from(joint)) != forest.root(index_from(joints[0]));
  };
  if (std::ranges::any_of(joints, has_other_root)) {
    asset.tolerate(at.member("joints"), "must have a common root node");
  }
  const JsonValue* skeleton = at.value->find("skeleton");
  if (skeleton == nullptr) return;
  const auto is_outside = [&](const JsonValue& joint) {
    return !forest.is_within(index_from(joint), index_from(*skeleton));
  };
  if (std::ranges::any_of(joints, is_outside)) {
    asset.tolerate(at.member("skeleton"), "is not a common ancestor of the skin's joints");
  }
}

void check_matrices(const Asset& asset, const Element& at, AccessorHeads& accessors) {
  if (at.value->find("inverseBindMatrices") == nullptr) return;
  const Element matrices = at.member("inverseBindMatrices");
  accessors.use(matrices, Purpose::inverse_bind_matrices);
  const AccessorHead& head = accessors[*matrices.value];
  if (head.format != Format{"MAT4", kFloat32}) {
    asset.fail(matrices, "refers to an accessor of " + head.format.text() +
                             "; inverse bind matrices must be MAT4 of componentType 5126");
  }
  const std::size_t joints = at.member("joints").value->items().size();
  // Without data, identity matrices are used.
  if (head.count > 0 && head.count < static_cast<double>(joints)) {
    asset.fail(matrices, "has " + std::to_string(static_cast<std::size_t>(head.count)) +
                             " matrices for " + std::to_string(joints) + " joints");
  }
}

/// For each node, true if it is a root and belongs to some scene.
std::vector<bool> roots_in_scenes(const Asset& asset, const NodeForest& forest) {
  std::vector<bool> result(asset.array("nodes").size());
  for (const JsonValue& scene : asset.array("scenes")) {
    const JsonValue* nodes = scene.find("nodes");
    if (nodes == nullptr) continue;
    for (const JsonValue& node : nodes->items()) result[forest.root(index_from(node))] = true;
  }
  return result;
}

}  // namespace

void check_skins(Asset& asset, AccessorHeads& accessors, const NodeForest& forest) {
  for (std::size_t i = 0; i < asset.array("skins").size(); ++i) {
    const Element at = asset.element("skins", i);
    check_joints(asset, at, forest);
    check_matrices(asset, at, accessors);
  }
  if (asset.array("skins").empty()) return;
  const std::vector<bool> in_scene = roots_in_scenes(asset, forest);
  for (std::size_t i = 0; i < asset.array("nodes").size(); ++i) {
    const Element at = asset.element("nodes", i);
    if (!in_scene[forest.root(i)] || at.value->find("skin") == nullptr) continue;
    const JsonValue& skin = asset.array("skins")[index_from(*at.value->find("skin"))];
    const std::vector<JsonValue>& joints = skin.find("joints")->items();
    if (!joints.empty() && !in_scene[forest.root(index_from(joints[0]))]) {
      asset.tolerate(at.member("skin"), "has joints that belong to no scene");
    }
  }
}

}  // namespace microtrace::io::gltf
