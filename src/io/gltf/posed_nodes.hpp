#pragma once
/// What a time makes of an asset's nodes.

#include "io/gltf/keyframes.hpp"

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
};

/// By node; one without is as the file has it.
using PosedNodes = std::unordered_map<std::size_t, NodePose>;

}  // namespace microtrace::io::gltf
