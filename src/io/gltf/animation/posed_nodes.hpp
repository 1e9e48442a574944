#pragma once
/// What a time makes of an asset.

#include "io/gltf/animation/keyframes.hpp"
#include "io/json/document.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

namespace microtrace::io::gltf {

/// What stands instead of a node's own properties.
struct NodePose {
  std::optional<DVec3> translation{}, scale{};
  std::optional<Quaternion> rotation{};  ///< of unit length
  std::optional<std::vector<double>> weights{};
  std::optional<bool> visible{};  ///< of KHR_node_visibility
};

/// By node; one without is as the file has it.
using PosedNodes = std::unordered_map<std::size_t, NodePose>;

struct PosedAsset {
  PosedNodes nodes{};
  /// Materials, cameras and extensions of the root object, where some of their properties are
  /// animated.
  std::optional<JsonValue> properties{};
};

}  // namespace microtrace::io::gltf
