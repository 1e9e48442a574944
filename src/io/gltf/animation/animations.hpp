#pragma once
/// Animations: selecting them, and evaluating them at a time.

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

/// The indices of the animations selected by a name, an index or "all"; an empty text selects the
/// first, if any. Throws Error (usage) that lists the existing ones.
[[nodiscard]] std::vector<std::size_t> choose_animations(const Asset& asset,
                                                         const std::string& wanted);

/// True if a channel of these animations targets a material's property.
[[nodiscard]] bool animate_materials(const Asset& asset,
                                     const std::vector<std::size_t>& animations);

/// Animations that are read and checked.
class AnimationPlayer {
 public:
  /// Ignores channels without a target node. Warns of properties that can't be animated and ignores
  /// their channels. Throws Error: invalid_scene, limit.
  AnimationPlayer(Asset& asset, const Model& model, AccessorReader& reader,
                  const std::vector<std::size_t>& animations);

  /// The values of all channels at a time in seconds. The last of several channels with the same
  /// target wins.
  [[nodiscard]] PosedAsset at(double time) const;

 private:
  enum class Path { translation, rotation, scale, weights, visibility, property };
  struct Channel {
    std::size_t node;  ///< unless the target is `property`
    Path path;
    AnimatedProperty property{};
    Keyframes keys;
  };
  class Reader;

  static void pose(NodePose& node, Path path, std::vector<double> value);

  std::vector<Channel> channels_;
  std::optional<JsonValue> properties_;  // unmodified; only if some are animated
};

}  // namespace microtrace::io::gltf
