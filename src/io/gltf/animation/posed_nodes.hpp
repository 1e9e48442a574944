#pragma once
/// The animated state of an asset at one time.

#include "io/gltf/animation/keyframes.hpp"
#include "io/json/document.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

namespace microtrace::io::gltf {

/// Animated properties of one node. They replace the node's own.
struct NodePose {
  std::optional<DVec3> translation{}, scale{};
  std::optional<Quaternion> rotation{};  ///< of unit length
  std::optional<std::vector<double>> weights{};
  std::optional<bool> visible{};  ///< of KHR_node_visibility
};

/// By node index. Nodes without an entry keep their own properties.
using PosedNodes = std::unordered_map<std::size_t, NodePose>;

struct PosedAsset {
  PosedNodes nodes{};
  /// A copy of materials, cameras and root extensions, if any of their properties is animated.
  std::optional<JsonValue> properties{};
};

}  // namespace microtrace::io::gltf
