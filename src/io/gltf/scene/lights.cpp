#include "io/gltf/scene/lights.hpp"

#include "io/gltf/document/extension.hpp"
#include "io/gltf/document/properties.hpp"
#include "io/gltf/scene/unique_names.hpp"

#include <cmath>
#include <numbers>
#include <optional>

namespace microtrace::io::gltf {
namespace {

constexpr const char* kExtensionName = "KHR_lights_punctual";
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Properties common to all kinds of lights.
struct Common {
  Vec3 color{1};
  float intensity = 1;
  double range = kInfinity;
};

struct Cone {
  double inner = 0, outer = std::numbers::pi / 4;
};

Common common_of(const JsonValue& light) {
  Common result{.color = vector(light, "color", Vec3(1)),
                .intensity = number(light, "intensity", 1)};
  if (const JsonValue* range = light.find("range")) result.range = range->number();
  return result;
}

Cone cone_of(const JsonValue& light) {
  Cone result;
  const JsonValue* spot = light.find("spot");
  if (spot == nullptr) return result;
  if (const JsonValue* inner = spot->find("innerConeAngle")) result.inner = inner->number();
  if (const JsonValue* outer = spot->find("outerConeAngle")) result.outer = outer->number();
  return result;
}

/// Returns the light at its place in the world, or nothing if its position or direction is not
/// valid.
std::optional<Light> placed(const JsonValue& light, const DMat4& world_from_node) {
  const std::string& type = light.find("type")->string();
  const auto [color, intensity, range] = common_of(light);
  const DVec3 position(world_from_node[3]);
  const std::optional<DVec3> direction = normalized(-DVec3(world_from_node[2]));
  const bool is_somewhere = std::isfinite(position.x + position.y + position.z);
  if (type == "directional") {
    if (!direction) return std::nullopt;
    return DirectionalLight{.direction = *direction, .color = color, .intensity = intensity};
  }
  if (type == "point") {
    if (!is_somewhere) return std::nullopt;
    return PointLight{.position = position, .color = color, .intensity = intensity, .range = range};
  }
  if (type != "spot") return std::nullopt;  // check_schema has warned
  const Cone cone = cone_of(light);
  if (!is_somewhere || !direction) return std::nullopt;
  return SpotLight{.position = position,
                   .direction = *direction,
                   .color = color,
                   .intensity = intensity,
                   .range = range,
                   .inner_angle = cone.inner,
                   .outer_angle = cone.outer};
}

}  // namespace

std::vector<NamedLight> make_lights(Asset& asset, const Element& root, const Model& model,
                                    const NodeTree& tree, const std::vector<PlacedNode>& nodes,
                                    UnflattenedNodes& unflattened) {
  std::vector<NamedLight> result;
  const std::optional<Element> all = extension(root, kExtensionName);
  if (!all) return result;
  const Element lights = all->member("lights");
  for (const PlacedNode& node : nodes) {
    const auto reference = extension(asset.element("nodes", node.node), kExtensionName);
    if (!reference || !node.visible) continue;
    const Element light =
        lights.item(index(asset, *reference, "light", lights.value->items().size()));
    const std::optional<Light> in_world = placed(*light.value, unflattened.at(node));
    if (!in_world) {
      asset.warn(reference->member("light"),
                 "has an unknown type, or no valid position or direction; the light is left out");
      continue;
    }
    const JsonValue* own = light.value->find("name");
    const bool named = !model.nodes[node.node].name.empty() || own == nullptr;
    result.push_back(
        {.name = named ? tree.name(node.node) : head(own->string(), 64), .light = *in_world});
  }
  make_names_unique(result);
  return result;
}

}  // namespace microtrace::io::gltf
