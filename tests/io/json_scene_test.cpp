#include <microtrace/io.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

constexpr std::string_view kMinimal = R"({
  "version": 1,
  "cameras": [{"type": "perspective", "position": [1, 2, 3], "direction": [0, 0, -2], "vertical_fov": 90}],
  "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1}]
})";

Scene parse(std::string_view text) {
  return parse_scene(text, "s.json", ".").scene;
}

TEST(JsonScene, FillsInEveryDefault) {
  const LoadedScene loaded = parse_scene(kMinimal, "s.json", ".");
  EXPECT_TRUE(loaded.warnings.empty());
  const Scene& scene = loaded.scene;
  EXPECT_EQ(scene.size.width, 640U);
  EXPECT_EQ(scene.size.height, 480U);
  EXPECT_EQ(scene.background, Vec3(0));
  EXPECT_EQ(scene.epsilon, 0);
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.cameras[0].name, "cameras/0");
  const auto& camera = std::get<PerspectiveCamera>(scene.cameras[0].camera);
  EXPECT_EQ(camera.pose.up, DVec3(0, 1, 0));
  EXPECT_EQ(camera.focus, 1);
  EXPECT_EQ(camera.aspect_ratio, std::nullopt);
  EXPECT_EQ(camera.depth.near, 0);
  EXPECT_TRUE(std::isinf(camera.depth.far));
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "objects/0");
  EXPECT_EQ(scene.objects[0].material, std::nullopt);
}

TEST(JsonScene, ReadsCameras) {
  const Scene scene =
      parse(R"({"version": 1, "objects": [{"type": "plane", "point": [0,0,0], "normal": [0,1,0]}],
    "cameras": [
      {"name": "p", "type": "perspective", "position": [1, 2, 3], "direction": [4, 5, 6], "up": [7, 8, 8], "vertical_fov": 90, "focus": 2.5, "lens_radius": 0.25},
      {"name": "o", "type": "orthographic", "position": [0.1, 2, 3], "direction": [4, 5, 6], "height": 7},
      {"type": "environment", "position": [1, 2, 3], "direction": [4, 5, 6]}]})");
  ASSERT_EQ(scene.cameras.size(), 3U);
  const auto& perspective = std::get<PerspectiveCamera>(scene.cameras[0].camera);
  EXPECT_EQ(scene.cameras[0].name, "p");
  EXPECT_EQ(perspective.pose.position, DVec3(1, 2, 3));
  EXPECT_EQ(perspective.pose.direction, DVec3(4, 5, 6));
  EXPECT_EQ(perspective.pose.up, DVec3(7, 8, 8));
  EXPECT_EQ(perspective.vertical_fov, std::numbers::pi / 2);
  EXPECT_EQ(perspective.focus, 2.5);
  EXPECT_EQ(perspective.lens_radius, 0.25);
  const auto& orthographic = std::get<OrthographicCamera>(scene.cameras[1].camera);
  EXPECT_EQ(orthographic.pose.position.x, 0.1);  // exact, because cameras are stored in float64
  EXPECT_EQ(orthographic.height, 7);
  EXPECT_EQ(std::get<EnvironmentCamera>(scene.cameras[2].camera).pose.position, DVec3(1, 2, 3));
  EXPECT_EQ(scene.cameras[2].name, "cameras/2");
}

TEST(JsonScene, ReadsCalibratedCameras) {
  const Scene scene =
      parse(R"({"version": 1, "objects": [{"type": "plane", "point": [0,0,0], "normal": [0,1,0]}],
    "cameras": [
      {"type": "calibrated", "position": [1, 2, 3], "direction": [4, 5, 6], "up": [7, 8, 8],
       "image": {"width": 1920, "height": 1080}, "fx": 1400.5, "fy": 1400.25, "cx": 950, "cy": 540,
       "distortion": {"type": "rational", "k1": 1, "k2": 2, "p1": 3, "p2": 4, "k3": 5, "k4": 6, "k5": 7, "k6": 8}},
      {"type": "calibrated", "extrinsic": [[1, 0, 0, 1], [0, 0, -1, 2], [0, 1, 0, 3], [0, 0, 0, 1]],
       "image": {"width": 64, "height": 48}, "fx": 1, "fy": 1, "cx": 0, "cy": 0,
       "distortion": {"type": "fisheye", "k1": 0.1, "k2": 0.2, "k3": 0.3, "k4": 0.4}}]})");
  ASSERT_EQ(scene.cameras.size(), 2U);
  const auto& first = std::get<CalibratedCamera>(scene.cameras[0].camera);
  EXPECT_EQ(first.pose.position, DVec3(1, 2, 3));
  EXPECT_EQ(first.pose.direction, DVec3(4, 5, 6));
  EXPECT_EQ(first.pose.up, DVec3(7, 8, 8));
  EXPECT_EQ(first.image.width, 1920U);
  EXPECT_EQ(first.image.height, 1080U);
  EXPECT_EQ(first.fx, 1400.5);
  EXPECT_EQ(first.fy, 1400.25);
  EXPECT_EQ(first.cx, 950);
  EXPECT_EQ(first.cy, 540);
  EXPECT_EQ(first.distortion, Distortion(RationalDistortion{1, 2, 3, 4, 5, 6, 7, 8}));
  const auto& second = std::get<CalibratedCamera>(scene.cameras[1].camera);
  // Forward is the matrix's third row, and down is its second row.
  EXPECT_EQ(second.pose.direction, DVec3(0, 1, 0));
  EXPECT_EQ(second.pose.up, DVec3(0, 0, 1));
  EXPECT_EQ(second.pose.position, DVec3(-1, -3, 2));
  EXPECT_EQ(second.distortion, Distortion(FisheyeDistortion{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(scene.size.width, 1920U);  // the first camera determines the size
  EXPECT_EQ(scene.size.height, 1080U);
}

TEST(JsonScene, ReadsShapesInFileOrder) {
  const Scene scene = parse(
      R"({"version": 1, "image": {"width": 7, "height": 5}, "background": "sky", "epsilon": 0.25,
    "colors": {"sky": [0.1, 0.2, 0.3], "red": [1, 0, 0]},
    "cameras": [{"type": "environment", "position": [0,0,0], "direction": [1,0,0]}],
    "objects": [
      {"type": "disc", "center": [1,2,3], "normal": [4,5,6], "radius": 7, "color": "red"},
      {"name": "t", "type": "triangle", "a": [1,2,3], "b": [4,5,6], "c": [7,8,9], "color": [0.5, 0.25, 1]},
      {"type": "sphere", "center": [0.1, 16777217, -1e-60], "radius": 0.1},
      {"type": "quadric", "coefficients": {"a":1,"b":2,"c":3,"d":4,"e":5,"f":6,"g":7,"h":8,"i":9,"j":10}},
      {"type": "quadric", "coefficients": {"h": -1}},
      {"type": "plane", "point": [1,2,3], "normal": [0,0,2]}]})");
  EXPECT_EQ(scene.size.width, 7U);
  EXPECT_EQ(scene.size.height, 5U);
  EXPECT_EQ(scene.background, Vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(scene.epsilon, 0.25F);
  ASSERT_EQ(scene.objects.size(), 6U);
  const auto& disc = std::get<Disc>(scene.objects[0].shape);
  EXPECT_EQ(disc.center, Vec3(1, 2, 3));
  EXPECT_EQ(disc.normal, Vec3(4, 5, 6));
  EXPECT_EQ(disc.radius, 7);
  EXPECT_EQ(material_of(scene, scene.objects[0]).base_color, Vec4(1, 0, 0, 1));
  const auto& triangle = std::get<Triangle>(scene.objects[1].shape);
  EXPECT_EQ(scene.objects[1].name, "t");
  EXPECT_EQ(triangle.a, Vec3(1, 2, 3));
  EXPECT_EQ(triangle.b, Vec3(4, 5, 6));
  EXPECT_EQ(triangle.c, Vec3(7, 8, 9));
  EXPECT_EQ(material_of(scene, scene.objects[1]).base_color, Vec4(0.5F, 0.25F, 1, 1));
  const auto& sphere = std::get<Sphere>(scene.objects[2].shape);
  EXPECT_EQ(sphere.center, Vec3(0.1F, 16777216.0F, 0));
  EXPECT_EQ(sphere.radius, 0.1F);
  EXPECT_EQ(scene.objects[2].name, "objects/2");
  const auto& q = std::get<Quadric>(scene.objects[3].shape);
  EXPECT_EQ(q.a + 10 * q.b + 100 * q.c, 321);
  EXPECT_EQ(q.d + 10 * q.e + 100 * q.f, 654);
  EXPECT_EQ(q.g + 10 * q.h + 100 * q.i + 1000 * q.j, 10987);
  EXPECT_EQ(std::get<Quadric>(scene.objects[4].shape).h, -1);
  EXPECT_EQ(std::get<Quadric>(scene.objects[4].shape).j, 0);
  EXPECT_EQ(std::get<Plane>(scene.objects[5].shape).normal, Vec3(0, 0, 2));
}

TEST(JsonScene, ReadsMaterials) {
  const Scene scene = parse(R"({"version": 1, "colors": {"red": [1, 0, 0]},
    "materials": {
      "lamp": {"emissive": [0, 5, 0]},
      "glass": {"base_color": "red", "roughness": 0.25, "ior": 1.75, "transmission": 1,
                "volume": {"attenuation_distance": 2}, "volume_scatter": {"anisotropy": -0.5}, "iridescence": {"thickness": 300}}},
    "objects": [
      {"type": "sphere", "center": [0,0,0], "radius": 1, "material": "glass"},
      {"type": "sphere", "center": [0,0,0], "radius": 2, "color": "red"},
      {"type": "sphere", "center": [0,0,0], "radius": 3, "material": "glass"}]})");
  ASSERT_EQ(scene.materials.size(), 3U);
  const Material& glass = material_of(scene, scene.objects.at(0));
  EXPECT_EQ(glass.name, "glass");
  EXPECT_EQ(glass.base_color, Vec4(1, 0, 0, 1));
  EXPECT_EQ(glass.metallic, 0);
  EXPECT_EQ(glass.roughness, 0.25F);
  EXPECT_EQ(glass.ior, 1.75F);
  EXPECT_EQ(glass.transmission.value().factor, 1);
  EXPECT_GT(glass.volume.value().thickness, 0);
  EXPECT_EQ(glass.volume.value().attenuation_distance, 2);
  EXPECT_EQ(glass.volume_scatter.value().multiscatter_color, Vec3(1));
  EXPECT_EQ(glass.volume_scatter.value().anisotropy, -0.5F);
  EXPECT_EQ(glass.iridescence.value().factor, 1);
  EXPECT_EQ(glass.iridescence.value().thickness_maximum, 300);
  EXPECT_FALSE(glass.clearcoat || glass.sheen || glass.specular || glass.diffuse_transmission);
  EXPECT_EQ(&material_of(scene, scene.objects.at(2)), &glass);
  EXPECT_EQ(material_of(scene, scene.objects.at(1)).base_color, Vec4(1, 0, 0, 1));
  EXPECT_FALSE(material_of(scene, scene.objects.at(1)).transmission);
}

TEST(JsonScene, ReadsLightsAndTheEnvironment) {
  const Scene scene = parse(R"({"version": 1,
    "lights": [
      {"type": "directional", "direction": [0, -2, 0], "intensity": 10},
      {"name": "lamp", "type": "spot", "position": [1, 2, 3], "direction": [0, 0, 3],
       "color": [1, 0.5, 0], "inner_angle": 30, "outer_angle": 90}],
    "environment": {"type": "uniform", "color": [0, 2, 0], "intensity": 3},
    "objects": [{"type": "plane", "point": [0,0,0], "normal": [0,1,0]}]})");
  ASSERT_EQ(scene.lights.size(), 2U);
  EXPECT_EQ(scene.lights[0].name, "lights/0");
  const auto& sun = std::get<DirectionalLight>(scene.lights[0].light);
  EXPECT_EQ(sun.direction, DVec3(0, -1, 0));
  EXPECT_EQ(sun.intensity, 10);
  EXPECT_EQ(scene.lights[1].name, "lamp");
  const auto& lamp = std::get<SpotLight>(scene.lights[1].light);
  EXPECT_EQ(lamp.position, DVec3(1, 2, 3));
  EXPECT_EQ(lamp.direction, DVec3(0, 0, 1));
  EXPECT_EQ(lamp.color, Vec3(1, 0.5F, 0));
  EXPECT_NEAR(lamp.inner_angle, std::numbers::pi / 6, 1e-15);
  EXPECT_EQ(lamp.outer_angle, std::numbers::pi / 2);
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(std::get<Vec3>(scene.environment->content), Vec3(0, 2, 0));
  EXPECT_EQ(scene.environment->intensity, 3);
  EXPECT_TRUE(scene.environment->is_background);
}

TEST(JsonScene, NamesThePlaceOfAnError) {
  std::string text(kMinimal);
  text.replace(text.find("\"radius\": 1"), 11, "\"radius\": -1");
  try {
    (void)parse_scene(text, "scene.json", ".");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
    EXPECT_EQ(error.diagnostic().file, "scene.json");
    EXPECT_EQ(error.diagnostic().line, 4U);
    EXPECT_EQ(error.diagnostic().column, 65U);
    EXPECT_EQ(error.diagnostic().pointer, "/objects/0/radius");
    EXPECT_EQ(error.diagnostic().message, "must be positive, is -1");
  }
}

// Quadratic time would be minutes.
TEST(JsonScene, ReadsManyObjects) {
  std::string text(kMinimal.substr(0, kMinimal.rfind(']')));
  for (int i = 0; i < 50'000; ++i) text += R"(,{"type":"sphere","center":[0,0,0],"radius":1})";
  EXPECT_EQ(parse(text + "]}").objects.size(), 50'001U);
}

TEST(JsonScene, CountsTheMemoryOfMaterials) {
  std::string text(kMinimal.substr(0, kMinimal.rfind('}')));
  text += R"(, "materials": {"first": {})";
  constexpr std::size_t kCount = 1000;
  for (std::size_t i = 1; i < kCount; ++i)
    text.append(R"(, ")").append(std::to_string(i)).append(R"(": {})");
  text += "}}";
  EXPECT_EQ(parse(text).materials.size(), kCount);
  MemoryBudget budget(kCount * sizeof(Material));
  EXPECT_THROW((void)parse_scene(text, "s.json", ".", {.memory = &budget}), Error);
}

}  // namespace
}  // namespace microtrace
