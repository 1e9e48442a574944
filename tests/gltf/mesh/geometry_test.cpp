#include "gltf/asset_builder.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Corners = std::array<Vec3, 3>;

/// `count` distinct vertices: (0, 0, 0), (1, 1, 0), (2, 4, 0), ...
std::vector<Vec3> points(int count) {
  std::vector<Vec3> result;
  for (int i = 0; i < count; ++i) result.emplace_back(i, i * i, 0);
  return result;
}

Corners corners(int a, int b, int c) {
  const std::vector<Vec3> p = points(1 + std::max({a, b, c}));
  return {p[static_cast<std::size_t>(a)], p[static_cast<std::size_t>(b)],
          p[static_cast<std::size_t>(c)]};
}

std::vector<Corners> loaded(const AssetBuilder& asset) {
  const LoadedScene scene = load(asset);
  return scene.scene.objects.empty() ? std::vector<Corners>{}
                                     : triangles_of(scene.scene.objects[0]);
}

TEST(GltfGeometry, ReadsIndicesOfEachTypeAndNone) {
  for (const ComponentType type : {kUint8, kUint16, kUint32}) {
    SCOPED_TRACE(type);
    AssetBuilder asset;
    const std::size_t positions = asset.add_positions(points(6));
    const std::size_t indices = asset.add_indices({5, 0, 2, 2, 1, 5}, type);
    asset.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    EXPECT_THAT(loaded(asset), ElementsAre(corners(5, 0, 2), corners(2, 1, 5)));
  }
  AssetBuilder asset;
  asset.add_object({{"attributes", {{"POSITION", asset.add_positions(points(6))}}}});
  EXPECT_THAT(loaded(asset), ElementsAre(corners(0, 1, 2), corners(3, 4, 5)));
}

TEST(GltfGeometry, OnlyUsedVerticesAreKept) {
  AssetBuilder asset;
  const std::size_t positions = asset.add_positions(points(300));
  const std::size_t indices = asset.add_indices({299, 7, 150, 7, 8, 299}, kUint16);
  asset.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  const LoadedScene scene = load(asset);
  const Mesh& mesh = std::get<Mesh>(scene.scene.objects[0].shape);
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3(7, 49, 0), Vec3(8, 64, 0), Vec3(150, 22500, 0),
                                          Vec3(299, 89401, 0)));
  EXPECT_THAT(mesh.triangles, ElementsAre(std::array{3U, 0U, 2U}, std::array{0U, 1U, 3U}));
}

TEST(GltfGeometry, StripsAndFansHaveTheSpecifiedWinding) {
  for (const int mode : {5, 6}) {
    SCOPED_TRACE(mode);
    AssetBuilder asset;
    asset.add_object(
        {{"attributes", {{"POSITION", asset.add_positions(points(5))}}}, {"mode", mode}});
    if (mode == 5) {
      EXPECT_THAT(loaded(asset), ElementsAre(corners(0, 1, 2), corners(1, 3, 2), corners(2, 3, 4)));
    } else {
      EXPECT_THAT(loaded(asset), ElementsAre(corners(1, 2, 0), corners(2, 3, 0), corners(3, 4, 0)));
    }
  }
}

TEST(GltfGeometry, ReadsInterleavedPositions) {
  AssetBuilder asset;
  std::vector<float> numbers = {99};  // precedes the accessor's offset
  for (const Vec3& p : points(3)) {
    for (const float number : {p.x, p.y, p.z, -7.F, -8.F}) numbers.push_back(number);
  }
  numbers.resize(numbers.size() - 2);  // the last element may be shorter than the stride
  const std::size_t view = asset.add_view(bytes_of(numbers), 20);
  const std::size_t accessor = asset.add("accessors", {{"bufferView", view},
                                                       {"byteOffset", 4},
                                                       {"componentType", kFloat32},
                                                       {"count", 3},
                                                       {"type", "VEC3"},
                                                       {"min", {0, 0, 0}},
                                                       {"max", {2, 4, 0}}});
  asset.add_object({{"attributes", {{"POSITION", accessor}}}});
  EXPECT_THAT(loaded(asset), ElementsAre(corners(0, 1, 2)));
}

Json sparse(std::size_t count, std::size_t indices, ComponentType type, std::size_t values) {
  return {{"count", count},
          {"indices", {{"bufferView", indices}, {"componentType", type}}},
          {"values", {{"bufferView", values}}}};
}

TEST(GltfGeometry, ReadsSparseAccessors) {
  AssetBuilder asset;
  const std::size_t accessor = asset.add_positions(points(3));
  const std::size_t indices = asset.add_view(bytes_of<std::uint8_t>({0, 2}));
  const std::size_t values = asset.add_view(bytes_of<Vec3>({Vec3(10), Vec3(20)}));
  asset.json["accessors"][accessor]["sparse"] = sparse(2, indices, kUint8, values);
  asset.add_object({{"attributes", {{"POSITION", accessor}}}});
  EXPECT_THAT(loaded(asset), ElementsAre(Corners{Vec3(10), Vec3(1, 1, 0), Vec3(20)}));
}

TEST(GltfGeometry, AccessorsWithoutViewAreZero) {
  AssetBuilder asset;
  const std::size_t changed = asset.add_view(bytes_of<std::uint32_t>({1, 2}));
  const std::size_t values = asset.add_view(bytes_of<Vec3>({Vec3(1, 0, 0), Vec3(0, 1, 0)}));
  const std::size_t positions =
      asset.add("accessors", {{"componentType", kFloat32},
                              {"count", 3},
                              {"type", "VEC3"},
                              {"min", {0, 0, 0}},
                              {"max", {1, 1, 0}},
                              {"sparse", sparse(2, changed, kUint32, values)}});
  const std::size_t which = asset.add_view(bytes_of<std::uint16_t>({0, 1}));
  const std::size_t vertices = asset.add_view(bytes_of<std::uint8_t>({2, 1}));
  const std::size_t indices =
      asset.add("accessors", {{"componentType", kUint8},
                              {"count", 3},
                              {"type", "SCALAR"},
                              {"sparse", sparse(2, which, kUint16, vertices)}});
  asset.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  EXPECT_THAT(loaded(asset), ElementsAre(Corners{Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0)}));
}

TEST(GltfGeometry, PointsAndLinesAreSegmentsOfTheMesh) {
  using Segments = std::vector<std::array<std::uint32_t, 2>>;
  const std::vector<Segments> expected = {
      {{1, 1}, {2, 2}, {0, 0}, {2, 2}, {1, 1}},  // POINTS
      {{1, 2}, {0, 2}},                          // LINES: the fifth index is ignored
      {{1, 2}, {2, 0}, {0, 2}, {2, 1}, {1, 1}},  // LINE_LOOP
      {{1, 2}, {2, 0}, {0, 2}, {2, 1}},          // LINE_STRIP
  };
  for (int mode = 0; mode < 4; ++mode) {
    AssetBuilder asset;
    // The indices use only vertices 3 to 5 of 6. The mesh numbers them 0 to 2.
    const std::size_t positions = asset.add_positions(points(6));
    const std::size_t indices = asset.add_indices({4, 5, 3, 5, 4}, kUint8);
    asset.add_object(
        {{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"mode", mode}});
    asset.json["nodes"][0]["scale"] = {2, 2, -2};
    const LoadedScene scene = load(asset);
    const Mesh& mesh = std::get<Mesh>(scene.scene.objects.at(0).shape);
    EXPECT_EQ(mesh.segments, expected[static_cast<std::size_t>(mode)]) << mode;
    EXPECT_EQ(mesh.positions[0].x, 2 * points(6)[3].x);
    EXPECT_THAT(mesh.triangles, IsEmpty());
    EXPECT_EQ(scene.warnings.size(), mode == 1 ? 1U : 0U) << mode;
  }
}

TEST(GltfGeometry, QuantizedPositionsAreScaledByTheirNode) {
  AssetBuilder asset;
  asset.json["extensionsUsed"] = asset.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const std::size_t view =
      asset.add_view(bytes_of<std::int16_t>({0, 0, 0, 0, 32767, -32768, 0, 0, 0, 0, -32767, 0}), 8);
  const std::size_t positions = asset.add("accessors", {{"bufferView", view},
                                                        {"componentType", 5122},
                                                        {"normalized", true},
                                                        {"count", 3},
                                                        {"type", "VEC3"},
                                                        {"min", {0, -32768, -32767}},
                                                        {"max", {32767, 0, 0}}});
  const std::size_t node = asset.add_object({{"attributes", {{"POSITION", positions}}}});
  asset.json["nodes"][node]["scale"] = {10, 20, 40};
  asset.json["nodes"][node]["translation"] = {1, 0, 0};
  const LoadedScene scene = load(asset);
  EXPECT_THAT(texts(scene.warnings), IsEmpty());
  EXPECT_THAT(triangles_of(scene.scene.objects.at(0)),
              ElementsAre(Corners{Vec3(1, 0, 0), Vec3(11, -20, 0), Vec3(1, 0, -40)}));
  asset.json["accessors"][positions]["normalized"] = false;
  EXPECT_THAT(triangles_of(load(asset).scene.objects.at(0)),
              ElementsAre(Corners{Vec3(1, 0, 0), Vec3(327671, -655360, 0), Vec3(1, 0, -1310680)}));
}

TEST(GltfGeometry, IncompletePrimitivesGiveAWarning) {
  struct Case {
    Json primitive;
    const char* warning;
  };
  const std::vector<Case> cases = {
      {{{"attributes", {{"_OWN", 0}}}}, "/meshes/0/primitives/0: has no POSITION"},
      {{{"attributes", Json::object()}}, "/meshes/0/primitives/0: has no POSITION"},
      {{{"attributes", {{"POSITION", 1}}}}, "incomplete triangle or line"},
      {{{"attributes", {{"POSITION", 2}}}, {"mode", 1}}, "incomplete triangle or line"},
  };
  for (const Case& c : cases) {
    AssetBuilder asset;
    asset.add_positions(points(6));
    asset.add_positions(points(2));
    asset.add_positions(points(1));
    asset.add_object(c.primitive);
    const LoadedScene scene = load(asset);
    EXPECT_THAT(scene.scene.objects, IsEmpty());
    EXPECT_THAT(texts(scene.warnings),
                ElementsAre(HasSubstr("nothing to draw"), HasSubstr(c.warning)));
  }
}

TEST(GltfGeometry, PositionsBeyondFloat32InTheWorldGiveAWarning) {
  AssetBuilder asset;
  asset.add_object(
      {{"attributes",
        {{"POSITION", asset.add_positions({Vec3(0), Vec3(1, 0, 0), Vec3(0, 1e30, 0)})}}}});
  asset.json["nodes"][0]["scale"] = {1e30, 1e30, 1e30};
  const LoadedScene scene = load(asset);
  ASSERT_EQ(scene.scene.objects.size(), 1U);
  EXPECT_TRUE(std::isinf(triangles_of(scene.scene.objects[0])[0][2].y));
  EXPECT_THAT(texts(scene.warnings),
              ElementsAre(HasSubstr("/meshes/0/primitives/0: has vertices that are not finite")));
}

/// Tests NaN and infinity in accessors that state no bounds.
TEST(GltfGeometry, TrianglesWithNonFiniteVerticesAreDropped) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  AssetBuilder asset;
  const std::size_t positions = asset.add_numbers<float>(
      "VEC3",
      {0, 0, 0, 1, 0, 0, kNan, 0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::infinity()});
  const std::size_t uvs = asset.add_numbers<float>("VEC2", {0, 1, kNan, 2, 3, 3, 4, kNan, 5, 5});
  const std::size_t normals =
      asset.add_numbers<float>("VEC3", {0, 0, 1, kNan, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const std::size_t indices = asset.add_indices({0, 1, 2, 0, 1, 3, 1, 3, 4}, kUint8);
  asset.add_object(
      {{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}, {"NORMAL", normals}}},
       {"indices", indices}});
  const LoadedScene scene = load(asset);
  const Mesh& mesh = std::get<Mesh>(scene.scene.objects.at(0).shape);
  EXPECT_THAT(triangles_of(scene.scene.objects[0]),
              ElementsAre(Corners{Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)}));
  EXPECT_THAT(mesh.uv_sets.at(0), ElementsAre(Vec2(0, 1), Vec2(0, 2), Vec2(4, 0)));
  EXPECT_THAT(mesh.normals, ElementsAre(Vec3(0, 0, 1), Vec3(0, 0, 1), Vec3(0, 0, 1)));
  EXPECT_THAT(texts(scene.warnings),
              testing::IsSupersetOf({HasSubstr("/accessors/0: element 2 is not finite"),
                                     HasSubstr("/accessors/1: element 1 is not finite (2 places)"),

                                     HasSubstr("/meshes/0/primitives/0: has vertices")}));
  asset.json["meshes"][0]["primitives"][0]["indices"] = asset.add_indices({0, 1, 2}, kUint8);
  EXPECT_THAT(load(asset).scene.objects, IsEmpty());
}

/// Tests the rules of glTF 2.0, section "Point and Line Materials".
TEST(GltfGeometry, PointsAndLinesWithoutNormalsAreUnlit) {
  const auto material_of = [](int mode, bool has_normals, bool has_material) {
    AssetBuilder asset;
    Json primitive = {{"attributes", {{"POSITION", asset.add_positions(points(6))}}},
                      {"mode", mode}};
    if (has_normals) primitive["attributes"]["NORMAL"] = asset.add_positions(points(6));
    if (has_material) {
      asset.json["materials"] = {{{"name", "m"}, {"emissiveFactor", {0, 0, 1}}}};
      primitive["material"] = 0;
    }
    asset.add_object(primitive);
    Json triangles = primitive;
    triangles["mode"] = 4;
    asset.add_object(triangles);
    const Scene scene = load(asset).scene;
    EXPECT_FALSE(scene.materials.at(scene.objects.at(1).material.value()).unlit);
    return scene.materials.at(scene.objects.at(0).material.value());
  };
  for (int mode = 0; mode < 5; ++mode) {
    EXPECT_EQ(material_of(mode, false, false).unlit, mode < 4) << mode;
    EXPECT_EQ(material_of(mode, false, true).unlit, mode < 4) << mode;
    EXPECT_FALSE(material_of(mode, true, true).unlit) << mode;
  }
  EXPECT_EQ(material_of(1, false, true).name, "m");
  EXPECT_EQ(material_of(1, false, true).emissive, Vec3(0, 0, 1));  // added to the base color
}

TEST(GltfGeometry, IntegersMayHaveADecimalPoint) {
  AssetBuilder asset = cube();
  std::string text = asset.embedded();
  const std::string count = "\"count\": 36";
  text.replace(text.find(count), count.size(), "\"count\": 36.0");
  EXPECT_EQ(triangles_of(load(text).scene.objects[0]).size(), 12U);
}

TEST(GltfGeometry, DefaultMaterialIsWhite) {
  AssetBuilder asset;
  asset.add_object({{"attributes", {{"POSITION", asset.add_positions(points(3))}}}});
  EXPECT_EQ(color_of(load(asset), 0), Vec4(1));
}

}  // namespace
}  // namespace microtrace::tests
