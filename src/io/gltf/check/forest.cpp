#include "io/gltf/check/forest.hpp"

#include "io/gltf/document/properties.hpp"

#include <string>

namespace microtrace::io::gltf {
namespace {

std::size_t child_count(const JsonValue& node) {
  const JsonValue* children = node.find("children");
  return children != nullptr ? children->items().size() : 0;
}

std::size_t child_of(const JsonValue& node, std::size_t number) {
  return index_from(node.find("children")->items()[number]);
}

}  // namespace

NodeForest::NodeForest(const Asset& asset) : places_(asset.array("nodes").size()) {
  if (places_.size() > kMaxNodes) {
    asset.fail(asset.root().member("nodes"), "has more than 2^20 nodes, the limit",
               ErrorKind::limit);
  }
  find_parents(asset);
  std::size_t number = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].parent == kNone) walk(asset.array("nodes"), i, number);
  }
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].root == kNone) {
      asset.fail(asset.element("nodes", i), "is part of a cycle: it has no root node");
    }
  }
}

void NodeForest::find_parents(const Asset& asset) {
  const std::vector<JsonValue>& nodes = asset.array("nodes");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < child_count(nodes[i]); ++k) {
      const std::size_t child = child_of(nodes[i], k);
      const auto at = [&] { return asset.element("nodes", i).member("children").item(k); };
      if (child == i) asset.fail(at(), "makes the node its own child");
      if (places_[child].parent != kNone) {
        asset.fail(at(), "gives node " + std::to_string(child) + " a second parent, after node " +
                             std::to_string(places_[child].parent) + "; copy the node instead");
      }
      places_[child].parent = i;
    }
  }
}

void NodeForest::walk(const std::vector<JsonValue>& nodes, std::size_t root, std::size_t& number) {
  struct Step {
    std::size_t node, next_child;
  };
  std::vector<Step> open = {{root, 0}};
  while (!open.empty()) {
    Step& step = open.back();
    Place& place = places_[step.node];
    if (step.next_child == 0) {
      place.root = root;
      place.first = number++;
    }
    if (step.next_child < child_count(nodes[step.node])) {
      open.push_back({child_of(nodes[step.node], step.next_child++), 0});
    } else {
      place.end = number;
      open.pop_back();
    }
  }
}

std::optional<std::size_t> NodeForest::parent(std::size_t node) const {
  if (places_[node].parent == kNone) return std::nullopt;
  return places_[node].parent;
}

}  // namespace microtrace::io::gltf
