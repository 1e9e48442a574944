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

/// Animated properties of one node. They replace the properties in the file.
struct NodePose {
  std::optional<DVec3> translation{}, scale{};
  std::optional<Quaternion> rotation{};  ///< unit quaternion
  std::optional<std::vector<double>> weights{};
  std::optional<bool> visible{};  ///< of KHR_node_visibility
};

/// Animated properties by node index. Nodes without an entry keep the properties in the file.
using PosedNodes = std::unordered_map<std::size_t, NodePose>;

struct PosedAsset {
  PosedNodes nodes{};
  /// A copy of the materials, cameras and root extensions with animated values. Absent if none of
  /// their properties is animated.
  std::optional<JsonValue> properties{};
};

}  // namespace microtrace::io::gltf
