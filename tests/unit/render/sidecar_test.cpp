#include <microtrace/sidecar.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace microtrace {
namespace {

using nlohmann::json;

/// Three objects whose names need JSON escapes. The film shows the first and the last.
Scene odd_scene() {
  Scene scene;
  scene.objects.push_back({.name = "a \"quoted\" \\ name\n", .shape = Sphere{{1, 2, 3}, 0.5F}});
  scene.objects.push_back({.name = "no text \xff", .shape = Mesh{}, .material = 0});
  scene.objects.push_back(
      {.name = "Größe/網",
       .shape = Mesh{.positions = {{0, 0, 0}, {NAN, 9, 9}, {-1, 0.1F, 2}}, .triangles = {}}});
  scene.materials.push_back({.name = "\tgold"});
  return scene;
}

Film film_of(const std::vector<std::uint32_t>& ids) {
  Film film({.width = 4, .height = 2});
  film.whole = {.width = 100, .height = 50};
  film.x0 = 10;
  film.y0 = 20;
  film.channels.push_back({.name = "id.instance", .values = ids});
  return film;
}

TEST(Sidecar, DescribesObjectsAndTheirPixels) {
  const std::string text = describe_picture(odd_scene(), PerspectiveCamera{},
                                            film_of({0, 1, 1, 0, 3, 0, 1, 0}), "a\"b.exr");
  const json sidecar = json::parse(text);
  EXPECT_EQ(sidecar["picture"], "a\"b.exr");
  EXPECT_EQ(sidecar["width"], 100);
  EXPECT_EQ(sidecar["height"], 50);
  EXPECT_EQ(sidecar["crop"], json({10, 20, 14, 22}));
  const json& objects = sidecar["objects"];
  ASSERT_EQ(objects.size(), 3U);
  EXPECT_EQ(objects[0]["name"], "a \"quoted\" \\ name\n");
  EXPECT_EQ(objects[0]["type"], "sphere");
  EXPECT_EQ(objects[0]["material"], 0);
  EXPECT_EQ(objects[0]["visible_pixels"], 3);
  EXPECT_EQ(objects[0]["box"], json({11, 20, 13, 22}));
  EXPECT_EQ(objects[0]["world_box"], json({{"min", {0.5, 1.5, 2.5}}, {"max", {1.5, 2.5, 3.5}}}));
  EXPECT_EQ(objects[1]["material"], 1);
  EXPECT_EQ(objects[1]["visible_pixels"], 0);
  EXPECT_TRUE(objects[1]["box"].is_null());
  EXPECT_TRUE(objects[1]["world_box"].is_null());
  EXPECT_EQ(objects[2]["name"], "Größe/網");
  EXPECT_EQ(objects[2]["box"], json({10, 21, 11, 22}));
  // The float32 numbers must be written without loss.
  EXPECT_EQ(objects[2]["world_box"]["max"], json({0.0, static_cast<double>(0.1F), 2.0}));
  EXPECT_EQ(sidecar["materials"], json::array({{{"id", 1}, {"name", "\tgold"}}}));
}

TEST(Sidecar, UsesTheFilesCoordinates) {
  Scene scene = odd_scene();
  scene.origin = {1e6, -2e6, 0.25};
  const PerspectiveCamera camera{.pose = {.position = {4, 5, 6}}};
  const json sidecar =
      json::parse(describe_picture(scene, camera, Film({.width = 4, .height = 2}), "a.exr"));
  EXPECT_EQ(sidecar["objects"][0]["world_box"],
            json({{"min", {1000000.5, -1999998.5, 2.75}}, {"max", {1000001.5, -1999997.5, 3.75}}}));
  const json& matrix = sidecar["camera"]["world_from_camera"];
  EXPECT_EQ(matrix[0][3], 1000004.0);
  EXPECT_EQ(matrix[1][3], -1999995.0);
  EXPECT_EQ(matrix[2][3], 6.25);
  EXPECT_EQ(sidecar["camera"]["camera_from_world"][0][3], -1000004.0);
}

TEST(Sidecar, WithoutIdsHasNoPixels) {
  Film film({.width = 4, .height = 2});
  const json sidecar =
      json::parse(describe_picture(odd_scene(), EnvironmentCamera{}, film, "a.png"));
  for (const json& object : sidecar["objects"]) {
    EXPECT_FALSE(object.contains("visible_pixels"));
    EXPECT_FALSE(object.contains("box"));
    EXPECT_TRUE(object.contains("world_box"));
  }
  EXPECT_EQ(sidecar["camera"]["type"], "environment");
  EXPECT_FALSE(sidecar["camera"].contains("fx"));
}

TEST(Sidecar, OfAnEmptySceneIsValidJson) {
  const json sidecar = json::parse(
      describe_picture(Scene{}, OrthographicCamera{}, film_of({0, 9, 0, 0, 0, 0, 0, 0}), ""));
  EXPECT_EQ(sidecar["objects"], json::array());
  EXPECT_EQ(sidecar["materials"], json::array());
}

TEST(Sidecar, CamerasByHand) {
  const Film film({.width = 100, .height = 50});
  const PerspectiveCamera camera{
      .pose = {.position = {1, 2, 3}, .direction = {-5, 0, 0}, .up = {1, 1, 0}},
      .vertical_fov = 2 * std::atan(0.5),
      .depth = {.near = 0.5, .far = std::numeric_limits<double>::infinity()}};
  const json c = json::parse(describe_picture(Scene{}, camera, film, ""))["camera"];
  // The camera looks along -x, so its right is -z, its up is y, and its backward is x.
  const double expected[4][4] = {{0, 0, 1, 1}, {0, 1, 0, 2}, {-1, 0, 0, 3}, {0, 0, 0, 1}};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      EXPECT_NEAR(c["world_from_camera"][row][column].get<double>(), expected[row][column], 1e-15);
    }
  }
  EXPECT_NEAR(c["fx"].get<double>(), 50, 1e-12);  // 25 pixels at a slope of 1/2
  EXPECT_EQ(c["fx"], c["fy"]);
  EXPECT_EQ(c["cx"], 50);
  EXPECT_EQ(c["cy"], 25);
  EXPECT_EQ(c["near"], 0.5);
  EXPECT_TRUE(c["far"].is_null());
  const json parallel =
      json::parse(describe_picture(Scene{}, OrthographicCamera{.height = 5}, film, ""))["camera"];
  EXPECT_NEAR(parallel["pixels_per_unit"].get<double>(), 10, 1e-12);
  EXPECT_FALSE(parallel.contains("fx"));
}

TEST(Sidecar, CalibratedCameras) {
  const Film film({.width = 100, .height = 50});
  CalibratedCamera camera{.image = {.width = 200, .height = 50},
                          .fx = 300,
                          .fy = 301,
                          .cx = 99.25,
                          .cy = 24,
                          .distortion = RationalDistortion{1, 2, 3, 4, 5, 6, 7, 8}};
  json c = json::parse(describe_picture(Scene{}, camera, film, ""))["camera"];
  EXPECT_EQ(c["type"], "calibrated");
  EXPECT_EQ(c["fx"], 150);
  EXPECT_EQ(c["fy"], 301);
  EXPECT_EQ(c["cx"], 49.875);  // (99.25 + 1/2) / 2
  EXPECT_EQ(c["cy"], 24.5);
  EXPECT_EQ(c["distortion"], json({{"type", "rational"},
                                   {"k1", 1},
                                   {"k2", 2},
                                   {"p1", 3},
                                   {"p2", 4},
                                   {"k3", 5},
                                   {"k4", 6},
                                   {"k5", 7},
                                   {"k6", 8}}));
  camera.distortion = FisheyeDistortion{0.1, 0.2, 0.3, 0.4};
  c = json::parse(describe_picture(Scene{}, camera, film, ""))["camera"];
  EXPECT_EQ(c["distortion"],
            json({{"type", "fisheye"}, {"k1", 0.1}, {"k2", 0.2}, {"k3", 0.3}, {"k4", 0.4}}));
}

}  // namespace
}  // namespace microtrace
