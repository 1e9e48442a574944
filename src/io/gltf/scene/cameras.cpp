#include "io/gltf/scene/cameras.hpp"

#include "io/gltf/document/properties.hpp"
#include "io/gltf/scene/unique_names.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

namespace microtrace::io::gltf {
namespace {

/// Returns the camera pose of a node. Uses only the node's position and orientation, because scale
/// must not distort a camera's view.
std::optional<Pose> pose_of(const DMat4& world_from_node) {
  const DVec3 position(world_from_node[3]);
  const auto direction = normalized(-DVec3(world_from_node[2]));
  const auto up = normalized(DVec3(world_from_node[1]));
  if (!direction || !up || !std::isfinite(position.x + position.y + position.z))
    return std::nullopt;
  if (glm::length(glm::cross(*direction, *up)) < 1e-6) return std::nullopt;
  return Pose{.position = position, .direction = *direction, .up = *up};
}

Camera camera_of(const JsonValue& camera, const Pose& pose) {
  const std::string& type = camera.find("type")->string();
  const JsonValue& projection = *camera.find(type);
  const auto number = [&projection](const char* key) { return projection.find(key)->number(); };
  if (type == "orthographic") {
    return OrthographicCamera{.pose = pose,
                              .height = 2 * std::abs(number("ymag")),
                              .aspect_ratio = std::abs(number("xmag") / number("ymag")),
                              .depth = {.near = number("znear"), .far = number("zfar")}};
  }
  PerspectiveCamera result{
      .pose = pose, .vertical_fov = number("yfov"), .depth = {.near = number("znear")}};
  if (projection.find("aspectRatio") != nullptr) result.aspect_ratio = number("aspectRatio");
  if (projection.find("zfar") != nullptr) result.depth.far = number("zfar");
  return result;
}

}  // namespace

std::vector<NamedCamera> make_cameras(Asset& asset, const JsonValue& root, const Model& model,
                                      const NodeTree& tree, const std::vector<PlacedNode>& nodes,
                                      UnflattenedNodes& unflattened) {
  std::vector<NamedCamera> result;
  for (const PlacedNode& placed : nodes) {
    const std::optional<std::size_t> index = model.nodes[placed.node].camera;
    if (!index) continue;
    const std::optional<Pose> pose = pose_of(unflattened.at(placed));
    if (!pose) {
      asset.warn(asset.element("nodes", placed.node).member("camera"),
                 "has no valid position and orientation; the camera is left out");
      continue;
    }
    const JsonValue& camera = root.find("cameras")->items()[*index];
    const std::string own = name_of(camera);
    const bool named = !model.nodes[placed.node].name.empty() || own.empty();
    result.push_back({.name = named ? tree.name(placed.node) : head(own, 64),
                      .camera = camera_of(camera, *pose)});
  }
  make_names_unique(result);
  return result;
}

}  // namespace microtrace::io::gltf
