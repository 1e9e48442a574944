#include "io/gltf/lights.hpp"

#include "io/gltf/extension.hpp"
#include "io/gltf/properties.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace microtrace::io::gltf {
namespace {

constexpr const char* name_of_extension = "KHR_lights_punctual";
constexpr double infinity = std::numeric_limits<double>::infinity();

/// What all kinds of light have.
struct Common {
  Vec3 color{1};
  float intensity = 1;
  double range = infinity;
};

struct Cone {
  double inner = 0, outer = std::numbers::pi / 4;
};

Common common_of(const Asset& asset, const Element& light) {
  Common result;
  if (light.value->find("color") != nullptr) {
    const Element color = light.member("color");
    const auto& items = color.value->items;
    if (items.size() != 3) asset.fail(color, "must be an array of three numbers");
    for (int i = 0; i < 3; ++i) {
      const JsonValue& item = items[static_cast<std::size_t>(i)];
      if (item.kind != JsonValue::Kind::number || item.number < 0) {
        asset.fail(color.item(static_cast<std::size_t>(i)), "must be a number of at least 0");
      }
      result.color[i] = finite_float(item.number);
    }
  }
  result.intensity = finite_float(number(asset, light, "intensity", 1, 0));
  result.range = number(asset, light, "range", infinity, std::numeric_limits<double>::min());
  return result;
}

Cone cone_of(const Asset& asset, const Element& light) {
  if (light.value->find("spot") == nullptr) {
    asset.fail(light, "lacks the property \"spot\" that its type asks for");
  }
  const Element spot = light.member("spot");
  Cone result;
  result.inner = number(asset, spot, "innerConeAngle", result.inner, 0, std::numbers::pi / 2);
  result.outer = number(asset, spot, "outerConeAngle", result.outer, 0, std::numbers::pi / 2);
  if (result.inner < result.outer) return result;
  asset.fail(spot, "must have an outerConeAngle that is greater than innerConeAngle");
}

/// Nothing if the light has no place in the world.
std::optional<Light> placed(const Asset& asset, const Element& light,
                            const DMat4& world_from_node) {
  const std::string& type = string(asset, light, "type");
  const auto [color, intensity, range] = common_of(asset, light);
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
  const Cone cone = cone_of(asset, light);
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

std::vector<NamedLight> make_lights(Asset& asset, const Element& root, const tinygltf::Model& model,
                                    const NodeTree& tree, const std::vector<PlacedNode>& nodes) {
  std::vector<NamedLight> result;
  const std::optional<Element> all = extension(root, name_of_extension);
  if (!all) return result;
  const Element lights = all->member("lights");
  for (std::size_t i = 0; i < lights.value->items.size(); ++i) {
    (void)placed(asset, lights.item(i), DMat4(1));  // each must be right, in use or not
  }
  UniqueNames names;
  for (const PlacedNode& node : nodes) {
    const auto reference = extension(asset.element("nodes", node.node), name_of_extension);
    if (!reference || !node.visible) continue;
    const Element light =
        lights.item(index(asset, *reference, "light", lights.value->items.size()));
    std::optional<Light> in_world = placed(asset, light, node.world_from_node);
    if (!in_world) {
      asset.warn(
          reference->member("light"),
          "has no known type, or no position and direction in the world; the light is left out");
      continue;
    }
    const JsonValue* own = light.value->find("name");
    const bool named = !model.nodes[node.node].name.empty() || own == nullptr;
    result.push_back({.name = names.make(named ? tree.name(node.node) : head(own->string, 64)),
                      .light = *std::move(in_world)});
  }
  return result;
}

}  // namespace microtrace::io::gltf
