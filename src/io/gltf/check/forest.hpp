#pragma once
/// Who is whose parent among an asset's nodes.

#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace microtrace::io::gltf {

inline constexpr std::size_t max_nodes = std::size_t{1} << 20;

class NodeForest {
 public:
  /// Throws Error: invalid_scene where nodes are no disjoint trees (glTF 2.0, section 3.5.2): a
  /// second parent, a cycle; limit for more than max_nodes.
  explicit NodeForest(const Asset& asset);

  [[nodiscard]] std::optional<std::size_t> parent(std::size_t node) const;
  [[nodiscard]] std::size_t root(std::size_t node) const { return places_[node].root; }
  /// Whether `node` is `ancestor` or below it.
  [[nodiscard]] bool is_within(std::size_t node, std::size_t ancestor) const {
    return places_[ancestor].first <= places_[node].first &&
           places_[node].first < places_[ancestor].end;
  }

 private:
  static constexpr std::size_t none = ~std::size_t{0};

  /// A walk over a tree, parents before children, gives a node and those below it the numbers from
  /// `first` to below `end`.
  struct Place {
    std::size_t parent = none, root = none, first = 0, end = 0;
  };

  void find_parents(const Asset& asset);
  void walk(const std::vector<JsonValue>& nodes, std::size_t root, std::size_t& number);

  std::vector<Place> places_;  // by node
};

}  // namespace microtrace::io::gltf
