#pragma once
/// The node tree, its traversal, and its transforms.

#include "io/gltf/animation/posed_nodes.hpp"
#include "io/gltf/check/forest.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

/// A node of the drawn scene.
struct PlacedNode {
  std::size_t node;
  DMat4 world_from_node;
  bool visible = true;  ///< product of its own and its ancestors' visibility (KHR_node_visibility);
                        ///< irrelevant for cameras
  bool numbered = true;  ///< visible, or hidden only by the pose; has objects, so that all poses of
                         ///< an animation give an object the same number and name
};

/// Returns translation * rotation * scale. The rotation must be a unit quaternion (x, y, z, w).
[[nodiscard]] DMat4 composed(const DVec3& translation, const glm::dvec4& rotation,
                             const DVec3& scale);

/// Returns the unit vector in the direction of v, or nothing if v has zero or infinite length.
[[nodiscard]] std::optional<DVec3> normalized(const DVec3& v);

class NodeTree {
 public:
  /// Expects nodes that check_nodes has accepted.
  explicit NodeTree(const Model& model);

  /// Returns the nodes of the default scene. Without a default scene, returns those of the first
  /// scene, and without scenes, all nodes. Parents precede their children, which are in file order.
  [[nodiscard]] std::vector<PlacedNode> place(Asset& asset, const DMat4& world_from_asset,
                                              const PosedNodes& pose) const;

  /// What a scale factor of 0 means. Animations hide meshes by such factors, which must not take
  /// away the orientation of cameras and lights.
  enum class ZeroScale { kept, as_one };

  /// Returns the transforms of all nodes, including those outside the scene.
  [[nodiscard]] std::vector<DMat4> everywhere(const DMat4& world_from_asset, const PosedNodes& pose,
                                              ZeroScale zero = ZeroScale::kept) const;

  /// Returns the names of the node's ancestors and of the node, separated by slashes. If these are
  /// more than 256 bytes, keeps whole names at the end and puts ".../" before them. Nodes without a
  /// name are called node0, node1 and so on, by index.
  [[nodiscard]] std::string path(std::size_t node) const;
  [[nodiscard]] std::string name(std::size_t node) const;

 private:
  [[nodiscard]] std::vector<std::size_t> roots() const;
  [[nodiscard]] DMat4 parent_from_node(std::size_t node, const PosedNodes& pose,
                                       ZeroScale zero = ZeroScale::kept) const;

  const Model& model_;
  std::vector<std::optional<std::size_t>> parents_;  // parent of each node; nothing for roots
};

/// The transforms of nodes with an orientation of their own, such as those of cameras and lights.
class UnflattenedNodes {
 public:
  /// All arguments must outlive this object.
  UnflattenedNodes(const NodeTree& tree, const DMat4& world_from_asset, const PosedNodes& pose)
      : tree_(tree), world_from_asset_(world_from_asset), pose_(pose) {}

  /// Returns the transform of a node to the world. If that transform maps space to a plane, a line
  /// or a point, scale factors of 0 count as 1, but the position remains.
  [[nodiscard]] DMat4 at(const PlacedNode& placed);

 private:
  const NodeTree& tree_;
  const DMat4& world_from_asset_;
  const PosedNodes& pose_;
  std::vector<DMat4> all_;  // computed when first needed
};

/// Returns at most `size` bytes from the start of UTF-8 text. Never splits a character.
[[nodiscard]] std::string head(std::string_view text, std::size_t size);

}  // namespace microtrace::io::gltf
