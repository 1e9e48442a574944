#include "gltf/asset_builder.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kPunctual = "KHR_lights_punctual";

/// Returns the cube, and each of these lights on a node of its own. All nodes have the same
/// rotation and scale.
AssetBuilder lit(const Json& lights) {
  AssetBuilder asset = cube();
  asset.json["extensionsUsed"] = {kPunctual};
  asset.json["extensions"][kPunctual]["lights"] = lights;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    // A rotation of 90 degrees about x maps -z to +y.
    const std::size_t node =
        asset.add("nodes", {{"translation", {1, 2, 3}},
                            {"rotation", {0.7071067811865476, 0, 0, 0.7071067811865476}},
                            {"scale", {2, 3, 4}},
                            {"extensions", {{kPunctual, {{"light", i}}}}}});
    asset.json["scenes"][0]["nodes"].push_back(node);
  }
  return asset;
}

TEST(GltfLights, ArePlacedByTheirNodes) {
  AssetBuilder asset =
      lit({{{"type", "directional"}, {"name", "Sun"}, {"intensity", 1000}, {"color", {1, 0.5, 0}}},
           {{"type", "point"}, {"range", 12}},
           {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}});
  asset.json["nodes"][2]["name"] = "Lamp";
  const LoadedScene scene = load(asset);
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.scene.lights, SizeIs(3));
  EXPECT_EQ(scene.scene.lights[0].name, "Sun");
  EXPECT_EQ(scene.scene.lights[1].name, "Lamp");
  EXPECT_EQ(scene.scene.lights[2].name, "node3");
  const auto& sun = std::get<DirectionalLight>(scene.scene.lights[0].light);
  EXPECT_NEAR(sun.direction.x, 0, 1e-15);
  EXPECT_NEAR(sun.direction.y, 1, 1e-15);
  EXPECT_NEAR(sun.direction.z, 0, 1e-15);
  EXPECT_EQ(sun.color, Vec3(1, 0.5, 0));
  EXPECT_EQ(sun.intensity, 1000);
  const auto& lamp = std::get<PointLight>(scene.scene.lights[1].light);
  EXPECT_EQ(lamp.position, DVec3(1, 2, 3));
  EXPECT_EQ(lamp.range, 12);
  EXPECT_EQ(lamp.intensity, 1);
  EXPECT_EQ(lamp.color, Vec3(1));
  const auto& spot = std::get<SpotLight>(scene.scene.lights[2].light);
  EXPECT_EQ(spot.position, DVec3(1, 2, 3));
  EXPECT_NEAR(spot.direction.y, 1, 1e-15);
  EXPECT_EQ(spot.range, std::numeric_limits<double>::infinity());
  EXPECT_EQ(spot.inner_angle, 0.25);
  EXPECT_EQ(spot.outer_angle, 0.5);
}

TEST(GltfLights, HiddenNodesHaveNone) {
  AssetBuilder asset = lit({{{"type", "point"}}});
  asset.json["extensionsUsed"].push_back("KHR_node_visibility");
  asset.json["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_THAT(load(asset).scene.lights, IsEmpty());
}

TEST(GltfLights, ZeroScalesKeepTheDirection) {
  AssetBuilder asset =
      lit({{{"type", "directional"}}, {{"type", "spot"}, {"spot", Json::object()}}});
  asset.json["nodes"][1]["scale"] = asset.json["nodes"][2]["scale"] = {0, 0, 0};
  const LoadedScene scene = load(asset);
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_THAT(scene.scene.lights, SizeIs(2));
  EXPECT_NEAR(std::get<DirectionalLight>(scene.scene.lights[0].light).direction.y, 1, 1e-15);
  const auto& spot = std::get<SpotLight>(scene.scene.lights[1].light);
  EXPECT_NEAR(spot.direction.y, 1, 1e-15);
  EXPECT_EQ(spot.position, DVec3(1, 2, 3));
}

// With a parent that flattens space, the light's own -z axis lies in a plane, but isn't 0.
TEST(GltfLights, FlatParentsKeepTheDirection) {
  AssetBuilder asset =
      lit({{{"type", "directional"}}, {{"type", "spot"}, {"spot", Json::object()}}});
  // Turns of 120 degrees about (1, 1, 1) / sqrt(3) and of about 53 degrees about x.
  asset.json["nodes"].push_back({{"children", {1, 2}}, {"rotation", {0.5, 0.5, 0.5, 0.5}}});
  asset.json["scenes"][0]["nodes"] = {0, 3};
  const double sine = std::sqrt(0.2), cosine = std::sqrt(0.8);
  for (const std::size_t node : {1, 2})
    asset.json["nodes"][node]["rotation"] = {sine, 0, 0, cosine};
  for (const DVec3& scale : {DVec3(1, 0, 1), DVec3(0, 2, 3), DVec3(1, 1, 0), DVec3(0, 0, 2)}) {
    asset.json["nodes"][3]["scale"] = {scale.x, scale.y, scale.z};
    const LoadedScene scene = load(asset);
    EXPECT_THAT(scene.warnings, IsEmpty());
    ASSERT_THAT(scene.scene.lights, SizeIs(2));
    const DVec3 direction = std::get<DirectionalLight>(scene.scene.lights[0].light).direction;
    // The light's node turns -z to (0, 0.8, -0.6), scaled where the parent's scale isn't 0. The
    // parent maps x to y, y to z, and z to x.
    const auto factor = [](double s) { return s == 0 ? 1 : s; };
    const DVec3 expected = glm::normalize(DVec3(-0.6 * factor(scale.z), 0, 0.8 * factor(scale.y)));
    EXPECT_NEAR(glm::distance(direction, expected), 0, 1e-15) << scale.x << " " << scale.y;
    const auto& spot = std::get<SpotLight>(scene.scene.lights[1].light);
    EXPECT_EQ(spot.direction, direction);
  }
}

TEST(GltfLights, MirroredZTurnsTheDirection) {
  AssetBuilder asset = lit({{{"type", "directional"}}});
  asset.json["nodes"][1]["scale"] = {1, 1, -1};
  const LoadedScene scene = load(asset);
  EXPECT_NEAR(std::get<DirectionalLight>(scene.scene.lights.at(0).light).direction.y, -1, 1e-15);
}

TEST(GltfLights, IgnoresLightsWithoutDirection) {
  AssetBuilder asset = lit({{{"type", "directional"}}, {{"type", "point"}}});
  for (const std::size_t node : {1, 2}) {
    const Json extensions = asset.json["nodes"][node]["extensions"];
    asset.json["nodes"][node] = {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}},
                                 {"extensions", extensions}};
  }
  const LoadedScene scene = load(asset);
  ASSERT_THAT(scene.scene.lights, SizeIs(1));
  EXPECT_TRUE(std::holds_alternative<PointLight>(scene.scene.lights[0].light));
  EXPECT_THAT(texts(scene.warnings), Contains(HasSubstr("the light is left out")));
}

TEST(GltfLights, InvalidLightsAreRefused) {
  const std::vector<Json> broken = {
      {{"intensity", 1}},
      {{"type", "point"}, {"color", {1, 1}}},
      {{"type", "point"}, {"intensity", "1"}},
  };
  for (const Json& light : broken) {
    try {
      (void)load(lit(Json::array({light})));
      ADD_FAILURE() << light << " accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
      EXPECT_THAT(error.diagnostic().pointer,
                  HasSubstr("/extensions/KHR_lights_punctual/lights/0"));
    }
  }
}

/// Loads the light with this JSON. Checks that loading gives a warning for it.
template <typename Kind>
Kind repaired(const Json& light) {
  const LoadedScene scene = load(lit(Json::array({light})));
  EXPECT_THAT(texts(scene.warnings),
              Contains(HasSubstr("/extensions/KHR_lights_punctual/lights/0")));
  return std::get<Kind>(scene.scene.lights.at(0).light);
}

TEST(GltfLights, NumbersOutOfRangeAreClamped) {
  const auto point = repaired<PointLight>(
      {{"type", "point"}, {"intensity", -1}, {"range", 0}, {"color", {1.5, -1, 0.5}}});
  EXPECT_EQ(point.intensity, 0);
  EXPECT_EQ(point.color, Vec3(1, 0, 0.5));
  EXPECT_EQ(point.range, std::numeric_limits<double>::infinity());
}

TEST(GltfLights, ConesAreRepaired) {
  const auto spot = [](const Json& cone) {
    return repaired<SpotLight>({{"type", "spot"}, {"spot", cone}});
  };
  const double quarter_turn = std::numbers::pi / 2, eighth = std::numbers::pi / 4;
  EXPECT_EQ(spot({{"outerConeAngle", 1.57079637}}).outer_angle, quarter_turn);
  EXPECT_EQ(spot({{"outerConeAngle", 3}, {"innerConeAngle", 2}}).outer_angle, quarter_turn);
  for (const double inner : {0.5, 0.6, 1.5}) {
    const SpotLight sharp = spot({{"innerConeAngle", inner}, {"outerConeAngle", 0.5}});
    EXPECT_EQ(sharp.inner_angle, std::nextafter(0.5, 0));
    EXPECT_EQ(sharp.outer_angle, 0.5);
  }
  EXPECT_EQ(spot({{"innerConeAngle", 1}}).inner_angle, std::nextafter(eighth, 0));
  const SpotLight dark = spot({{"innerConeAngle", -1}, {"outerConeAngle", 0}});
  EXPECT_EQ(dark.inner_angle, 0);
  EXPECT_GT(dark.outer_angle, 0);
  EXPECT_EQ(repaired<SpotLight>({{"type", "spot"}}).outer_angle, eighth);
}

}  // namespace
}  // namespace microtrace::tests
