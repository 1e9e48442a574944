#include "io/gltf/cameras.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

namespace microtrace::io::gltf {
namespace {

/// Only position and orientation of the node: scale does not distort what a camera sees.
std::optional<Pose> pose_of(const DMat4& world_from_node) {
  const DVec3 position(world_from_node[3]);
  const auto direction = normalized(-DVec3(world_from_node[2]));
  const auto up = normalized(DVec3(world_from_node[1]));
  if (!direction || !up || !std::isfinite(position.x + position.y + position.z))
    return std::nullopt;
  if (glm::length(glm::cross(*direction, *up)) < 1e-6) return std::nullopt;
  return Pose{.position = position, .direction = *direction, .up = *up};
}

std::optional<double> optional(double value) {
  return value > 0 ? std::optional(value) : std::nullopt;  // tinygltf writes 0 for what is absent
}

Camera camera_of(const tinygltf::Camera& camera, const Pose& pose) {
  if (camera.type == "orthographic") {
    const auto& o = camera.orthographic;
    return OrthographicCamera{.pose = pose,
                              .height = 2 * std::abs(o.ymag),
                              .aspect_ratio = std::abs(o.xmag / o.ymag),
                              .depth = {.near = o.znear, .far = o.zfar}};
  }
  const auto& p = camera.perspective;
  PerspectiveCamera result{.pose = pose,
                           .vertical_fov = p.yfov,
                           .aspect_ratio = optional(p.aspectRatio),
                           .depth = {.near = p.znear}};
  if (p.zfar > 0) result.depth.far = p.zfar;
  return result;
}

}  // namespace

std::vector<NamedCamera> make_cameras(Asset& asset, const tinygltf::Model& model,
                                      const NodeTree& tree, const std::vector<PlacedNode>& nodes) {
  UniqueNames names;
  std::vector<NamedCamera> result;
  for (const PlacedNode& placed : nodes) {
    const int index = model.nodes[placed.node].camera;
    if (index < 0) continue;
    const std::optional<Pose> pose = pose_of(placed.world_from_node);
    if (!pose) {
      asset.warn(asset.element("nodes", placed.node).member("camera"),
                 "has no position and orientation in the world; the camera is left out");
      continue;
    }
    const tinygltf::Camera& camera = model.cameras[static_cast<std::size_t>(index)];
    const bool named = !model.nodes[placed.node].name.empty() || camera.name.empty();
    result.push_back({.name = names.make(named ? tree.name(placed.node) : head(camera.name, 64)),
                      .camera = camera_of(camera, *pose)});
  }
  return result;
}

}  // namespace microtrace::io::gltf
