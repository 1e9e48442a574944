#include "io/gltf/pose/nodes.hpp"

#include "io/gltf/document/extension.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace::io::gltf {
namespace {

constexpr std::size_t kLongestName = 64, kLongestPath = 256;

bool starts_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

/// Returns the visibility of the node itself, if the pose animates it.
std::optional<bool> posed_visibility(std::size_t node, const PosedNodes& pose) {
  const auto posed = pose.empty() ? pose.end() : pose.find(node);
  return posed != pose.end() ? posed->second.visible : std::nullopt;
}

/// Returns true if the file itself shows the node.
bool is_shown(const Asset& asset, const Model& model, std::size_t node) {
  if (!model.nodes[node].has_extensions) return true;
  const auto visibility = extension(asset.element("nodes", node), "KHR_node_visibility");
  if (!visibility) return true;
  const JsonValue* visible = visibility->value->find("visible");
  return visible == nullptr || visible->kind() != JsonValue::Kind::boolean || visible->boolean();
}

/// Returns true if the transform maps space to a plane, a line or a point. Products of matrices are
/// rounded, so the axes may be nearly in a plane instead.
bool is_flat(const DMat4& matrix) {
  const auto x = normalized(DVec3(matrix[0])), y = normalized(DVec3(matrix[1])),
             z = normalized(DVec3(matrix[2]));
  return !x || !y || !z || std::abs(glm::dot(glm::cross(*x, *y), *z)) < 1e-6;
}

}  // namespace

std::optional<DVec3> normalized(const DVec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return std::nullopt;
  return glm::normalize(v / largest);
}

NodeTree::NodeTree(const Model& model) : model_(model), parents_(model.nodes.size()) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    for (const std::size_t child : model.nodes[i].children) parents_[child] = i;
  }
}

std::vector<std::size_t> NodeTree::roots() const {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < parents_.size(); ++i) {
    if (!parents_[i]) result.push_back(i);
  }
  return result;
}

DMat4 NodeTree::parent_from_node(std::size_t index, const PosedNodes& pose, ZeroScale zero) const {
  static const NodePose kAsInFile;
  const Model::Node& node = model_.nodes[index];
  const auto posed = pose.empty() ? pose.end() : pose.find(index);
  const auto& [translation, scale, rotation, weights, visible] =
      posed != pose.end() ? posed->second : kAsInFile;
  if (node.matrix && !translation && !scale && !rotation) {
    DMat4 result = *node.matrix;
    for (int i = 0; i < 4; ++i)
      result[i][3] = i < 3 ? 0 : 1;  // check_nodes warns if the last row differs
    return result;
  }
  DVec3 factors = scale.value_or(node.scale);
  if (zero == ZeroScale::as_one) {
    for (int i = 0; i < 3; ++i)
      if (factors[i] == 0) factors[i] = 1;
  }
  return composed(translation.value_or(node.translation),
                  rotation.value_or(unit_quaternion(node.rotation)), factors);
}

std::vector<PlacedNode> NodeTree::place(Asset& asset, const DMat4& world_from_asset,
                                        const PosedNodes& pose) const {
  std::vector<std::size_t> first;
  if (model_.scenes.empty()) {
    if (!model_.nodes.empty()) {
      asset.warn(asset.root(), "the asset has no scene; all its nodes are drawn");
    }
    first = roots();
  } else {
    first = model_.scenes[model_.scene];
  }
  // A scene that lists a child node as a root is invalid. If the parent is drawn too, the child is
  // placed only below its parent.
  std::stable_partition(first.begin(), first.end(),
                        [this](std::size_t node) { return !parents_[node]; });
  struct Open {
    std::size_t node;
    std::optional<std::size_t> parent;  // by its index in the result
  };
  std::vector<bool> placed(parents_.size());
  std::vector<PlacedNode> result;
  result.reserve(parents_.size());
  std::vector<Open> open;
  for (std::size_t i = first.size(); i-- > 0;) open.push_back({first[i], std::nullopt});
  while (!open.empty()) {
    const auto [node, parent] = open.back();
    open.pop_back();
    if (placed[node]) continue;
    placed[node] = true;
    const DMat4& world_from_parent = parent ? result[*parent].world_from_node : world_from_asset;
    const std::optional<bool> posed = posed_visibility(node, pose);
    const bool shown = posed ? *posed : is_shown(asset, model_, node);
    result.push_back({.node = node,
                      .world_from_node = world_from_parent * parent_from_node(node, pose),
                      .visible = (!parent || result[*parent].visible) && shown,
                      .numbered = (!parent || result[*parent].numbered) && (shown || posed)});
    const std::vector<std::size_t>& children = model_.nodes[node].children;
    for (std::size_t i = children.size(); i-- > 0;) {
      open.push_back({children[i], result.size() - 1});
    }
  }
  return result;
}

std::vector<DMat4> NodeTree::everywhere(const DMat4& world_from_asset, const PosedNodes& pose,
                                        ZeroScale zero) const {
  std::vector<DMat4> result(parents_.size());
  std::vector<std::size_t> open = roots();
  for (const std::size_t root : open) {
    result[root] = world_from_asset * parent_from_node(root, pose, zero);
  }
  while (!open.empty()) {
    const std::size_t next = open.back();
    open.pop_back();
    for (const std::size_t child : model_.nodes[next].children) {
      result[child] = result[next] * parent_from_node(child, pose, zero);
      open.push_back(child);
    }
  }
  return result;
}

std::string NodeTree::name(std::size_t node) const {
  const std::string& given = model_.nodes[node].name;
  return given.empty() ? "node" + std::to_string(node) : head(given, kLongestName);
}

std::string NodeTree::path(std::size_t node) const {
  std::vector<std::string> names = {name(node)};
  std::size_t size = names[0].size();
  bool is_whole = true;
  for (std::optional<std::size_t> parent = parents_[node]; parent && is_whole;
       parent = parents_[*parent]) {
    std::string above = name(*parent);
    size += above.size() + 1;
    is_whole = size <= kLongestPath;
    if (is_whole) names.push_back(std::move(above));
  }
  std::string result = is_whole ? names.back() : ".../" + names.back();
  for (std::size_t i = names.size() - 1; i-- > 0;) result.append("/").append(names[i]);
  return result;
}

DMat4 composed(const DVec3& translation, const glm::dvec4& rotation, const DVec3& scale) {
  const auto [x, y, z, w] = std::array{rotation.x, rotation.y, rotation.z, rotation.w};
  DMat4 result(1);
  result[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0};
  result[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0};
  result[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0};
  for (int i = 0; i < 3; ++i) result[i] *= scale[i];
  result[3] = glm::dvec4(translation, 1);
  return result;
}

std::string head(std::string_view text, std::size_t size) {
  if (text.size() <= size) return std::string(text);
  while (size > 0 && !starts_character(text[size])) --size;
  return std::string(text.substr(0, size));
}

DMat4 UnflattenedNodes::at(const PlacedNode& placed) {
  if (!is_flat(placed.world_from_node)) return placed.world_from_node;
  if (all_.empty()) all_ = tree_.everywhere(world_from_asset_, pose_, NodeTree::ZeroScale::as_one);
  DMat4 result = all_[placed.node];
  result[3] = placed.world_from_node[3];
  return result;
}

}  // namespace microtrace::io::gltf
