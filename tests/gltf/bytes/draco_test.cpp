#include "gltf/asset_builder.hpp"
#include "gltf/draco_sample.hpp"

#include <dlfcn.h>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kExtension = "KHR_draco_mesh_compression";
const DracoSample& sample(bool sequential) {
  static const std::array<DracoSample, 2> samples = [] {
    void* module = ::dlopen(MICROTRACE_DRACO_SAMPLE, RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) throw std::runtime_error(::dlerror());
    const auto make = reinterpret_cast<MakeDracoSample>(::dlsym(module, "make_draco_sample"));
    std::array<DracoSample, 2> result;
    make(false, result[0]);
    make(true, result[1]);
    return result;
  }();
  return samples[sequential ? 1 : 0];
}

AssetBuilder asset_of(const std::string& bytes) {
  AssetBuilder asset;
  asset.json["extensionsUsed"] = asset.json["extensionsRequired"] = {kExtension};
  const DracoSample& ids = sample(false);
  const std::size_t points = kDracoRows * kDracoColumns;
  asset.add("accessors", {{"componentType", kFloat32},
                          {"count", points},
                          {"type", "VEC3"},
                          {"min", {-1, -1, -1}},
                          {"max", {1, 1, 1}}});
  asset.add("accessors", {{"componentType", kFloat32}, {"count", points}, {"type", "VEC3"}});
  asset.add("accessors",
            {{"componentType", kUint8}, {"normalized", true}, {"count", points}, {"type", "VEC4"}});
  asset.add("accessors",
            {{"componentType", kUint16}, {"count", ids.triangles.size() * 3}, {"type", "SCALAR"}});
  const std::size_t view = asset.add_view(bytes);
  asset.add_object({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"COLOR_0", 2}}},
                    {"indices", 3},
                    {"extensions",
                     {{kExtension,
                       {{"bufferView", view},
                        {"attributes",
                         {{"POSITION", ids.position_id},
                          {"NORMAL", ids.normal_id},
                          {"COLOR_0", ids.color_id}}}}}}}});
  return asset;
}

TEST(GltfDraco, MeshesEqualThoseOfTheDracoLibrary) {
  for (const bool sequential : {false, true}) {
    const DracoSample& expected = sample(sequential);
    const LoadedScene scene = load(asset_of(expected.bytes));
    EXPECT_THAT(scene.warnings, IsEmpty());
    const Mesh& mesh = std::get<Mesh>(scene.scene.objects.at(0).shape);
    EXPECT_EQ(mesh.positions, expected.positions);
    EXPECT_EQ(mesh.triangles, expected.triangles);
    ASSERT_EQ(mesh.normals.size(), expected.normals.size());
    ASSERT_EQ(mesh.colors.size(), expected.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(mesh.normals[i][k], expected.normals[i][k], 2e-7) << i;
        EXPECT_NEAR(mesh.normals[i][k], mesh.positions[i][k], 1e-2) << i;
      }
      EXPECT_EQ(mesh.colors[i].y, 7 / 255.0F);
      EXPECT_EQ(mesh.colors[i].w, 1);
    }
  }
}

void expect_refused(const AssetBuilder& asset, const char* message) {
  try {
    (void)load(asset);
    ADD_FAILURE() << message << ": accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
    EXPECT_THAT(error.diagnostic().pointer, HasSubstr("/meshes/0/primitives/0")) << message;
    EXPECT_THAT(error.diagnostic().message, HasSubstr(message));
  }
}

TEST(GltfDraco, AccessorsWithOtherCountsAreIgnoredWithAWarning) {
  const DracoSample& expected = sample(false);
  for (const auto& [vertices, indices] :
       {std::pair<int, int>{0, 3}, {0, -3}, {1, 0}, {-1, 0}, {-20, -30}, {1000, 3000}}) {
    AssetBuilder asset = asset_of(expected.bytes);
    const auto add = [&](std::size_t accessor, int number) {
      Json& count = asset.json["accessors"][accessor]["count"];
      count = static_cast<int>(count.to_size()) + number;
      return count.to_size();
    };
    for (std::size_t i = 0; i < 2; ++i) add(i, vertices);
    add(3, indices);
    // The compressed data lacks this attribute, so its accessor states the number of values.
    const std::size_t uvs = add(2, vertices);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        asset.add_numbers<float>("VEC2", std::vector<float>(2 * uvs, 0.5F));
    const LoadedScene scene = load(asset);
    const Mesh& mesh = std::get<Mesh>(scene.scene.objects.at(0).shape);
    EXPECT_EQ(mesh.positions, expected.positions);
    EXPECT_EQ(mesh.triangles, expected.triangles);
    ASSERT_EQ(mesh.uv_sets.at(0).size(), expected.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      EXPECT_EQ(mesh.uv_sets[0][i], Vec2(i < uvs ? 0.5F : 0));
    }
    EXPECT_THAT(texts(scene.warnings),
                testing::Contains(testing::AllOf(
                    HasSubstr("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: "),
                    HasSubstr("not as many as the accessors state"))));
  }
}

/// A mesh of two triangles as Draco's bitstream 2.2, sequential and not compressed.
std::string two_triangles(std::size_t points, const std::string& attributes) {
  std::string result("DRACO\2\2\1\0\0\0", 11);
  result += {2, static_cast<char>(points), 1};  // counts; indices follow as they are
  return result + std::string("\0\1\2\2\3\0", 6) + attributes;
}

// Version 1.5.5 of Draco's library rejects them.
TEST(GltfDraco, PointsThatNoTriangleUsesAreReadOrNamed) {
  constexpr std::size_t kPoints = 100;
  std::string attributes("\1\1\0\x09\3\0\0\0", 8);  // one decoder of one attribute: VEC3, float32
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < kPoints; ++i)
    positions.emplace_back(static_cast<float>(i % 2), static_cast<float>(i / 2), 0);
  attributes.append(reinterpret_cast<const char*>(positions.data()), kPoints * sizeof(Vec3));
  AssetBuilder asset = asset_of(two_triangles(kPoints, attributes));
  Json& primitive = asset.json["meshes"][0]["primitives"][0];
  primitive["attributes"] = {{"POSITION", 0}};
  primitive["extensions"][kExtension]["attributes"] = {{"POSITION", 0}};
  for (const std::size_t i : {0, 1, 2}) asset.json["accessors"][i]["count"] = kPoints;
  asset.json["accessors"][3]["count"] = 6;
  try {
    const LoadedScene scene = load(asset);
    EXPECT_EQ(std::get<Mesh>(scene.scene.objects.at(0).shape).positions, positions);
  } catch (const Error& error) {
    EXPECT_THAT(error.diagnostic().message, HasSubstr("points that no triangle uses"));
  }
}

// Some tools compress only the indices of meshes with sparse positions.
TEST(GltfDraco, MayHoldOnlyIndices) {
  AssetBuilder asset = asset_of(two_triangles(0, std::string(1, '\0')));
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  Json& primitive = asset.json["meshes"][0]["primitives"][0];
  primitive["attributes"] = {{"POSITION", asset.add_positions(positions)}};
  primitive["extensions"][kExtension]["attributes"] = Json::object();
  asset.json["accessors"][3]["count"] = 6;
  const LoadedScene scene = load(asset);
  const Mesh& mesh = std::get<Mesh>(scene.scene.objects.at(0).shape);
  EXPECT_EQ(mesh.positions, positions);
  EXPECT_THAT(mesh.triangles,
              testing::ElementsAre(testing::ElementsAre(0, 1, 2), testing::ElementsAre(2, 3, 0)));
  asset.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      asset.add_positions({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  EXPECT_THROW(static_cast<void>(load(asset)), Error);
}

TEST(GltfDraco, IndicesMustFitTheirComponentType) {
  AssetBuilder asset = asset_of(sample(false).bytes);
  asset.json["accessors"][3]["componentType"] = kUint8;
  expect_refused(asset, "too many for the componentType");
}

TEST(GltfDraco, DataOfAnotherMeshIsRefused) {
  const std::string bytes = sample(false).bytes;
  AssetBuilder asset = asset_of(bytes);
  asset.json["meshes"][0]["primitives"][0]["extensions"][kExtension]["attributes"]["COLOR_0"] = 99;
  expect_refused(asset, "no attribute of an id");
  asset = asset_of(bytes);
  asset.json["accessors"][2]["type"] = "VEC3";
  expect_refused(asset, "accessor's type");
  asset = asset_of("this is no mesh at all");
  expect_refused(asset, "can't");
}

TEST(GltfDraco, DamagedDataGivesErrorsOrValidMeshes) {
  std::mt19937 random(5);
  const std::string good[] = {sample(false).bytes, sample(true).bytes};
  for (int i = 0; i < 600; ++i) {
    std::string bytes = good[i % 2];
    if (random() % 4 == 0) bytes.resize(1 + random() % bytes.size());
    for (unsigned k = random() % 4; k > 0; --k) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    try {
      const LoadedScene scene = load(asset_of(bytes));
      for (const Object& object : scene.scene.objects) {
        const Mesh& mesh = std::get<Mesh>(object.shape);
        for (const auto& corners : mesh.triangles) {
          for (const std::uint32_t corner : corners) ASSERT_LT(corner, mesh.positions.size());
        }
      }
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene) << error.what();
    }
  }
}

}  // namespace
}  // namespace microtrace::tests
