#include "io/json/document.hpp"
#include "io/scene_json/mesh.hpp"
#include "support/source_folder.hpp"

#include <string>
#include <variant>

#include <gmock/gmock.h>

namespace microtrace::io {
namespace {

using ::testing::StartsWith;

DMat4 transform(std::string_view text) {
  const JsonDocument document(text, "s.json");
  return read_transform(JsonReader(document));
}

DVec3 apply(const DMat4& m, DVec3 p) {
  return DVec3(m * glm::dvec4(p, 1));
}

TEST(Transform, AbsentPartsChangeNothing) {
  EXPECT_EQ(transform("{}"), DMat4(1));
}

TEST(Transform, ScalesThenRotatesThenTranslates) {
  const DMat4 m = transform(
      R"({"translation": [10, 20, 30], "rotation": {"axis": [0, 0, 5], "angle": 90}, "scale": [2, 3, 4]})");
  EXPECT_EQ(apply(m, DVec3(1, 0, 0)), DVec3(10, 22, 30));
  EXPECT_EQ(apply(m, DVec3(0, 1, 0)), DVec3(7, 20, 30));
  EXPECT_EQ(apply(m, DVec3(0, 0, 1)), DVec3(10, 20, 34));
  EXPECT_EQ(transform(R"({"scale": -2})")[1][1], -2);
}

TEST(Transform, RotatesCounterclockwise) {
  const DMat4 about_x = transform(R"({"rotation": {"axis": [1, 0, 0], "angle": 90}})");
  EXPECT_EQ(apply(about_x, DVec3(0, 1, 0)), DVec3(0, 0, 1));
  const DMat4 about_y = transform(R"({"rotation": {"axis": [0, 1, 0], "angle": -90}})");
  EXPECT_EQ(apply(about_y, DVec3(0, 0, 1)), DVec3(-1, 0, 0));
  const DVec3 turned =
      apply(transform(R"({"rotation": {"axis": [1, 1, 1], "angle": 120}})"), DVec3(1, 0, 0));
  EXPECT_NEAR(turned.x, 0, 1e-15);
  EXPECT_NEAR(turned.y, 1, 1e-15);
  EXPECT_NEAR(turned.z, 0, 1e-15);
}

TEST(Transform, MatrixIsColumnMajor) {
  const DMat4 m = transform(R"({"matrix": [1,2,3,0, 4,5,6,0, 7,8,9,0, 10,11,12,1]})");
  EXPECT_EQ(apply(m, DVec3(0)), DVec3(10, 11, 12));
  EXPECT_EQ(apply(m, DVec3(1, 0, 0)), DVec3(11, 13, 15));
}

class MeshObject : public ::testing::Test {
 protected:
  static LoadedScene load(const std::string& objects) {
    const std::string text = R"({"version": 1,
      "cameras": [{"type": "environment", "position": [0,0,0], "direction": [1,0,0]}],
      "objects": [)" + objects +
                             "]}";
    return parse_scene(text, "s.json", tests::source_folder() / "scenes");
  }
};

TEST_F(MeshObject, IsPlacedNamedAndColored) {
  const Scene scene = load(R"({"name": "a", "type": "mesh", "file": "gltf/cube.glb"},
    {"type": "mesh", "file": "gltf/cube.glb", "color": [0, 0.5, 1], "transform": {"translation": [100, 0, 0]}})")
                          .scene;
  ASSERT_EQ(scene.objects.size() % 2, 0U);
  const std::size_t half = scene.objects.size() / 2;
  ASSERT_GE(half, 1U);
  for (std::size_t i = 0; i < half; ++i) {
    const Object& plain = scene.objects[i];
    const Object& moved = scene.objects[half + i];
    EXPECT_THAT(plain.name.str(), StartsWith("a/"));
    EXPECT_EQ(moved.name, "objects/1/" + plain.name.str().substr(2));
    EXPECT_EQ(material_of(scene, moved).base_color, Vec4(0, 0.5F, 1, 1));
    const Mesh& a = std::get<Mesh>(plain.shape);
    const Mesh& b = std::get<Mesh>(moved.shape);
    ASSERT_EQ(a.positions.size(), b.positions.size());
    ASSERT_FALSE(a.triangles.empty());
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_NEAR(a.positions[0].x + 100, b.positions[0].x, 1e-4F);
  }
}

TEST_F(MeshObject, MayNotHaveTheNameOfAnotherObject) {
  const std::string mesh = R"({"name": "a", "type": "mesh", "file": "gltf/cube.glb"})";
  const std::string name = load(mesh).scene.objects[0].name.str();
  const std::string ball =
      R"({"name": ")" + name + R"(", "type": "sphere", "center": [0,0,0], "radius": 1})";
  for (const bool mesh_is_first : {true, false}) {
    try {
      (void)load(mesh_is_first ? mesh + "," + ball : ball + "," + mesh);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
      EXPECT_EQ(error.diagnostic().pointer, "/objects/1");
      EXPECT_EQ(error.diagnostic().message,
                "the name of its object \"" + name +
                    "\" is already used by /objects/0; names must differ");
    }
  }
}

TEST_F(MeshObject, IgnoresCamerasOfItsFile) {
  EXPECT_EQ(load(R"({"type": "mesh", "file": "gltf/cube.glb"})").scene.cameras.size(), 1U);
}

TEST_F(MeshObject, NamesThePathOfAMissingFile) {
  try {
    (void)load(R"({"type": "mesh", "file": "gltf/none.glb"})");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    EXPECT_EQ(error.diagnostic().pointer, "/objects/0/file");
    EXPECT_EQ(error.diagnostic().message,
              (tests::source_folder() / "scenes/gltf/none.glb").string() +
                  " can't be opened: No such file or directory");
  }
}

}  // namespace
}  // namespace microtrace::io
