#pragma once
/// An asset's animations: which there are, and what they make of the nodes at a time.

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

/// The indices of the animations that are meant by a name, else an index, else "all"; of the first,
/// if there is one, by an empty text. Throws Error (usage), which lists those that there are.
[[nodiscard]] std::vector<std::size_t> choose_animations(const Asset& asset,
                                                         const std::string& wanted);

/// Whether a channel of these animations points to a property of a material.
[[nodiscard]] bool animate_materials(const Asset& asset,
                                     const std::vector<std::size_t>& animations);

/// Animations, read and checked.
class AnimationPlayer {
 public:
  /// Channels without a target node, and those of properties that can't be animated, play no part;
  /// for the latter there is a warning. Throws Error: invalid_scene, limit.
  AnimationPlayer(Asset& asset, const Model& model, AccessorReader& reader,
                  const std::vector<std::size_t>& animations);

  /// What all channels say at that time, in seconds. Where two have one target, the later one
  /// holds.
  [[nodiscard]] PosedAsset at(double time) const;

 private:
  enum class Path { translation, rotation, scale, weights, visibility, property };
  struct Channel {
    std::size_t node;  ///< but of `property`
    Path path;
    AnimatedProperty property{};
    Keyframes keys;
  };
  class Reader;

  static void pose(NodePose& node, Path path, std::vector<double> value);

  std::vector<Channel> channels_;
  std::optional<JsonValue> properties_;  // as the file has them, where some are animated
};

}  // namespace microtrace::io::gltf
