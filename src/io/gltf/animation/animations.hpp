#pragma once
/// Selects animations and evaluates them at a given time.

#include "io/gltf/animation/keyframes.hpp"
#include "io/gltf/animation/posed_nodes.hpp"
#include "io/gltf/animation/property.hpp"
#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::io::gltf {

/// Returns the indices of the animations that a name, an index or "all" selects. An empty text
/// selects the first one, if any. Throws an Error (usage) that lists the existing animations.
[[nodiscard]] std::vector<std::size_t> choose_animations(const Asset& asset,
                                                         const std::string& wanted);

/// Returns true if a channel of these animations targets a material's property.
[[nodiscard]] bool animate_materials(const Asset& asset,
                                     const std::vector<std::size_t>& animations);

/// Reads and checks animations, and evaluates them at any time.
class AnimationPlayer {
 public:
  /// Ignores channels without a target node. Ignores channels of properties that can't be animated,
  /// with a warning. Throws Error: invalid_scene, limit.
  AnimationPlayer(Asset& asset, const Model& model, AccessorReader& reader,
                  const std::vector<std::size_t>& animations);

  /// Returns the values of all channels at a time in seconds. If several channels have the same
  /// target, the last one applies.
  [[nodiscard]] PosedAsset at(double time) const;

 private:
  enum class Path { translation, rotation, scale, weights, visibility, property };
  struct Channel {
    std::size_t node;  ///< not used if `path` is `property`
    Path path;
    AnimatedProperty property{};
    Keyframes keys;
  };
  class Reader;

  static void pose(NodePose& node, Path path, std::vector<double> value);

  std::vector<Channel> channels_;
  std::optional<JsonValue> properties_;  // not yet animated; present only if some will be
};

}  // namespace microtrace::io::gltf
