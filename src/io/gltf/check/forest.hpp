#pragma once
/// The parents of an asset's nodes.

#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace microtrace::io::gltf {

inline constexpr std::size_t kMaxNodes = std::size_t{1} << 20;

class NodeForest {
 public:
  /// Throws Error: invalid_scene if a node has two parents or is in a cycle (glTF 2.0, section
  /// 3.5.2), limit for more than kMaxNodes.
  explicit NodeForest(const Asset& asset);

  [[nodiscard]] std::optional<std::size_t> parent(std::size_t node) const;
  [[nodiscard]] std::size_t root(std::size_t node) const { return places_[node].root; }
  /// Returns true if `node` is `ancestor` or a descendant of it.
  [[nodiscard]] bool is_within(std::size_t node, std::size_t ancestor) const {
    return places_[ancestor].first <= places_[node].first &&
           places_[node].first < places_[ancestor].end;
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  /// The position of a node in its tree. The node and its descendants have the preorder numbers in
  /// [first, end).
  struct Place {
    std::size_t parent = kNone, root = kNone, first = 0, end = 0;
  };

  void find_parents(const Asset& asset);
  void walk(const std::vector<JsonValue>& nodes, std::size_t root, std::size_t& number);

  std::vector<Place> places_;  // by node
};

}  // namespace microtrace::io::gltf
