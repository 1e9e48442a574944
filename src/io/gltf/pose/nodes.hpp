#pragma once
/// The node tree: checked, walked, and composed.

#include "io/gltf/animation/posed_nodes.hpp"
#include "io/gltf/check/forest.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <microtrace/math.hpp>

#include <cstddef>
#include <functional>
#include <memory_resource>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace microtrace::io::gltf {

/// A node of the scene being drawn.
struct PlacedNode {
  std::size_t node;
  DMat4 world_from_node;
  bool visible = true;  ///< itself and all above it (KHR_node_visibility); says nothing of cameras
};

/// translation * rotation * scale, the rotation a quaternion (x, y, z, w) of unit length.
[[nodiscard]] DMat4 composed(const DVec3& translation, const glm::dvec4& rotation,
                             const DVec3& scale);

/// The direction of a vector; nothing if its length is zero or not finite.
[[nodiscard]] std::optional<DVec3> normalized(const DVec3& v);

class NodeTree {
 public:
  /// Of nodes that check_nodes has accepted.
  explicit NodeTree(const Model& model);

  /// The nodes of the default scene, else of the first one, else all: parents before children,
  /// children in their order.
  [[nodiscard]] std::vector<PlacedNode> place(Asset& asset, const DMat4& world_from_asset,
                                              const PosedNodes& pose) const;

  /// The same transforms by node, of those outside the scene too.
  [[nodiscard]] std::vector<DMat4> everywhere(const DMat4& world_from_asset,
                                              const PosedNodes& pose) const;

  /// The names of the node and those above it, with slashes between; at most 256 bytes, of which
  /// the last are kept. A node without name is called node0 by its index.
  [[nodiscard]] std::string path(std::size_t node) const;
  [[nodiscard]] std::string name(std::size_t node) const;

 private:
  [[nodiscard]] std::vector<std::size_t> roots() const;
  [[nodiscard]] DMat4 local(std::size_t node) const;
  [[nodiscard]] DMat4 parent_from_node(std::size_t node, const PosedNodes& pose) const;

  const Model& model_;
  std::vector<std::optional<std::size_t>> parents_;  // of all nodes but roots
  std::vector<DMat4> parent_from_node_;
};

/// Hands out each name once: a second "Cube" is called "Cube (2)".
class UniqueNames {
 public:
  [[nodiscard]] std::string make(const std::string& name);
  void reserve(std::size_t names) { uses_.reserve(names); }

 private:
  struct Hash {
    using is_transparent = void;
    // Without noexcept, which makes libstdc++ store the hashes and spare most looks at names.
    std::size_t operator()(std::string_view name) const {
      return std::hash<std::string_view>{}(name);
    }
  };

  // Millions of instances have names: an arena takes them, and gives them back, at once.
  std::pmr::monotonic_buffer_resource memory_;
  std::pmr::unordered_map<std::pmr::string, std::size_t, Hash, std::equal_to<>> uses_{&memory_};
};

/// At most `size` bytes from the start of UTF-8 text, cut between characters.
[[nodiscard]] std::string head(std::string_view text, std::size_t size);

}  // namespace microtrace::io::gltf
