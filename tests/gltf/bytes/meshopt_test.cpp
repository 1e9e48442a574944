#include "gltf/meshopt_asset.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr MeshoptFormat kFormats[] = {kExtMeshopt, {kKhrMeshopt.extension, 0}, kKhrMeshopt};

constexpr unsigned kSide = 12;  // number of vertices of a wavy grid along each side

std::vector<std::int16_t> grid_positions() {
  std::vector<std::int16_t> result;
  for (unsigned y = 0; y < kSide; ++y) {
    for (unsigned x = 0; x < kSide; ++x) {
      const auto push = [&](unsigned v) { result.push_back(static_cast<std::int16_t>(v)); };
      push(x * 100), push(y * 100), push((x * y) % 37), push(0);
    }
  }
  return result;
}

std::vector<unsigned> grid_triangles() {
  std::vector<unsigned> result;
  for (unsigned y = 0; y + 1 < kSide; ++y) {
    for (unsigned x = 0; x + 1 < kSide; ++x) {
      const unsigned a = y * kSide + x;
      result.insert(result.end(), {a, a + 1, a + kSide, a + 1, a + kSide + 1, a + kSide});
    }
  }
  return result;
}

/// Returns a grid of triangles. If `triangles` is false, a line strip, which is compressed in mode
/// INDICES.
MeshoptAsset grid(const MeshoptFormat& format, bool triangles,
                  const std::function<void(std::string&)>& spoil = {}) {
  MeshoptAsset result(format.extension);
  const std::vector<std::int16_t> positions = grid_positions();
  const std::vector<unsigned> corners = grid_triangles();
  std::string vertices = encoded_attributes(bytes_of(positions), 8, format.version);
  std::string indices = triangles ? encoded_triangles(corners) : encoded_indices(corners);
  if (spoil) spoil(vertices), spoil(indices);
  const std::size_t vertex_view = result.add_view(vertices, "ATTRIBUTES", kSide * kSide, 8);
  const std::size_t index_view =
      result.add_view(indices, triangles ? "TRIANGLES" : "INDICES", corners.size(), 2);
  const std::size_t position = result.add_accessor(vertex_view, 5122, "VEC3", kSide * kSide);
  result.asset.json["accessors"][position]["max"] = {1100, 1100, 36};
  const std::size_t index = result.add_accessor(index_view, kUint16, "SCALAR", corners.size());
  result.asset.add_object(
      {{"attributes", {{"POSITION", position}}}, {"indices", index}, {"mode", triangles ? 4 : 3}});
  return result;
}

std::string format_name(const ::testing::TestParamInfo<MeshoptFormat>& format) {
  return std::string(format.param.extension, 3) + "Version" + std::to_string(format.param.version);
}

class GltfMeshopt : public ::testing::TestWithParam<MeshoptFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, GltfMeshopt, ::testing::ValuesIn(kFormats), format_name);

TEST_P(GltfMeshopt, TrianglesAndAttributesAreDecoded) {
  const LoadedScene scene = load(grid(GetParam(), true).json().dump());
  EXPECT_THAT(scene.warnings, IsEmpty());
  const Mesh& mesh = std::get<Mesh>(scene.scene.objects.at(0).shape);
  ASSERT_EQ(mesh.positions.size(), kSide * kSide);
  EXPECT_EQ(mesh.positions[kSide * kSide - 1],
            Vec3((kSide - 1) * 100, (kSide - 1) * 100, (kSide - 1) * (kSide - 1) % 37));
  const std::vector<unsigned> corners = grid_triangles();
  ASSERT_EQ(mesh.triangles.size() * 3, corners.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    // The codec may rotate the order of a triangle's vertices.
    std::array<unsigned, 3> expected = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
    for (int k = 0; k < 3 && expected != mesh.triangles[i]; ++k) {
      expected = {expected[1], expected[2], expected[0]};
    }
    EXPECT_EQ(mesh.triangles[i], expected) << i;
  }
}

TEST_P(GltfMeshopt, IndexSequencesAreDecoded) {
  const LoadedScene scene = load(grid(GetParam(), false).json().dump());
  const Mesh& mesh = std::get<Mesh>(scene.scene.objects.at(0).shape);
  const std::vector<unsigned> corners = grid_triangles();
  ASSERT_EQ(mesh.segments.size() + 1, corners.size());
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) {
    EXPECT_EQ(mesh.segments[i], (std::array<std::uint32_t, 2>{corners[i], corners[i + 1]}));
  }
}

TEST_P(GltfMeshopt, ExponentialFilterGivesFloats) {
  MeshoptAsset asset(GetParam().extension);
  const auto exponential = [](int exponent, int mantissa) {
    return static_cast<std::uint32_t>(exponent) << 24U |
           (static_cast<std::uint32_t>(mantissa) & 0xFFFFFFU);
  };
  const std::vector<std::uint32_t> words = {
      exponential(0, 3),  exponential(-1, 5), exponential(-2, -1),
      exponential(1, -7), exponential(10, 1), exponential(-20, 0),
      exponential(0, 0),  exponential(0, 1),  exponential(-23, 1)};
  const std::size_t view =
      asset.add_view(encoded_attributes(bytes_of(words), 12, GetParam().version), "ATTRIBUTES", 3,
                     12, "EXPONENTIAL");
  asset.asset.add_object(
      {{"attributes", {{"POSITION", asset.add_accessor(view, kFloat32, "VEC3", 3)}}}});
  EXPECT_THAT(triangles_of(load(asset.json().dump()).scene.objects.at(0)),
              ElementsAre(std::array{Vec3(3, 2.5, -0.25), Vec3(-14, 1024, 0),
                                     Vec3(0, 1, 1.1920928955078125e-07F)}));
}

/// Returns a triangle whose vertex colors are stored as YCoCg with 3 bits.
Json colored_triangle(const MeshoptFormat& format) {
  MeshoptAsset asset(format.extension);
  const std::vector<std::uint8_t> colors = {1, 2, 255, 7, 3, 0, 0, 6, 4, 0, 3, 5};
  const std::size_t view = asset.add_view(encoded_attributes(bytes_of(colors), 4, format.version),
                                          "ATTRIBUTES", 3, 4, "COLOR");
  const std::size_t color = asset.add_accessor(view, kUint8, "VEC4", 3, true);
  asset.asset.add_object(
      {{"attributes",
        {{"POSITION", asset.asset.add_positions({Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)})},
         {"COLOR_0", color}}}});
  return asset.json();
}

TEST(GltfMeshoptExtensions, ColorFilterGivesColors) {
  for (const int version : {0, 1}) {
    const LoadedScene scene = load(colored_triangle({kKhrMeshopt.extension, version}).dump());
    EXPECT_THAT(scene.warnings, IsEmpty());
    const Mesh& mesh = std::get<Mesh>(scene.scene.objects.at(0).shape);
    ASSERT_EQ(mesh.colors.size(), 3U);
    const auto of_7 = [](int r, int g, int b, int a) {
      const auto x = [](int v) { return std::round(static_cast<float>(v) * 255 / 7) / 255; };
      return Vec4(x(r), x(g), x(b), x(a));
    };
    EXPECT_EQ(mesh.colors[0], of_7(4, 0, 0, 7));
    EXPECT_EQ(mesh.colors[1], of_7(3, 3, 3, 4));
    EXPECT_EQ(mesh.colors[2], of_7(1, 7, 1, 3));
  }
}

TEST(GltfMeshoptExtensions, ZerosAreCompressedAThousandfold) {
  constexpr std::size_t kCount = 100'000;
  MeshoptAsset asset(kKhrMeshopt.extension);
  const std::string bytes = encoded_attributes(std::string(kCount * 12, '\0'), 12, 1);
  ASSERT_GT(kCount * 12 / bytes.size(), 500U);
  const std::size_t view = asset.add_view(bytes, "ATTRIBUTES", kCount, 12);
  asset.asset.add_object(
      {{"attributes", {{"POSITION", asset.add_accessor(view, kFloat32, "VEC3", kCount)}}},
       {"mode", 0}});
  EXPECT_EQ(std::get<Mesh>(load(asset.json().dump()).scene.objects.at(0).shape).positions.size(),
            kCount);
}

TEST(GltfMeshoptExtensions, OneExtensionExcludesTheOther) {
  Json json = grid(kKhrMeshopt, true).json();
  const std::size_t objects = load(json.dump()).scene.objects.size();
  json["extensionsUsed"].push_back(kExtMeshopt.extension);
  Json& extensions = json["bufferViews"][0]["extensions"];
  extensions[kExtMeshopt.extension] = extensions[kKhrMeshopt.extension];
  json["buffers"][1]["extensions"][kExtMeshopt.extension] = {{"fallback", false}};
  const LoadedScene scene = load(json.dump());
  EXPECT_EQ(scene.scene.objects.size(), objects);
  EXPECT_THAT(texts(scene.warnings),
              ElementsAre("/bufferViews/0/extensions/EXT_meshopt_compression: must not be combined "
                          "with KHR_meshopt_compression; it is ignored (2 places)"));
}

TEST_P(GltfMeshopt, ViolationsOfTheExtensionAreRefused) {
  struct Case {
    std::size_t view;
    Json change;  // members of the extension object to change
    const char* message;
  };
  const std::vector<Case> cases = {
      {0, {{"byteStride", 12}}, "byteStride"},
      {0, {{"count", 100}}, "gives the view"},
      {0, {{"filter", "QUATERNIONS"}}, ""},
      {1, {{"filter", "COLOR"}}, "filter"},
      {0, {{"byteLength", 1 << 20}}, "beyond its buffer"},
      {0, {{"byteLength", 1}}, ""},
      {0, {{"byteOffset", 1e15}}, "beyond its buffer"},
      {0, {{"mode", "TRIANGLES"}}, "byteStride 2 or 4"},
      {0, {{"mode", "SOMETHING"}}, ""},
      {1, {{"mode", "ATTRIBUTES"}}, "multiple of 4"},
      {1, {{"filter", "OCTAHEDRAL"}}, "filter"},
      {1, {{"buffer", 7}}, ""},
  };
  for (const Case& c : cases) {
    Json json = grid(GetParam(), true).json();
    json["bufferViews"][c.view]["extensions"][GetParam().extension].update(c.change);
    try {
      (void)load(json.dump());
      ADD_FAILURE() << c.change << " accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene) << c.change;
      EXPECT_THAT(error.diagnostic().pointer, HasSubstr("/bufferViews/")) << c.change;
      EXPECT_THAT(error.diagnostic().message, HasSubstr(c.message)) << c.change;
    }
  }
}

TEST(GltfMeshoptExtensions, FeaturesOfKhrAreNamedInExt) {
  const auto complaint = [](const Json& json) -> std::string {
    try {
      (void)load(json.dump());
      return "accepted";
    } catch (const Error& error) {
      return error.diagnostic().pointer + ": " + error.diagnostic().message;
    }
  };
  EXPECT_THAT(complaint(grid({kExtMeshopt.extension, 1}, true).json()),
              AllOf(StartsWith("/bufferViews/0/extensions/EXT_meshopt_compression: "),
                    HasSubstr("attributes of version 1")));
  EXPECT_THAT(complaint(colored_triangle(kExtMeshopt)), HasSubstr("filter COLOR, which only KHR_"));
}

TEST_P(GltfMeshopt, CountsBeyondTheDataAreRefusedBeforeAllocation) {
  Json json = grid(GetParam(), true).json();
  const double count = 4e8;
  json["bufferViews"][0]["byteLength"] = json["buffers"][1]["byteLength"] = count * 8;
  json["bufferViews"][0]["byteOffset"] = 0;
  json["bufferViews"][0]["extensions"][GetParam().extension]["count"] = count;
  try {
    (void)load(json.dump());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.diagnostic().message, HasSubstr("more elements than its bytes can hold"));
  }
}

TEST_P(GltfMeshopt, DamagedDataGivesErrorsOrValidMeshes) {
  std::mt19937 random(4);
  for (int i = 0; i < 1000; ++i) {
    const auto spoil = [&random](std::string& bytes) {
      if (random() % 4 == 0) bytes.resize(1 + random() % bytes.size());
      for (unsigned k = random() % 4; k > 0; --k) {
        bytes[random() % bytes.size()] = static_cast<char>(random());
      }
    };
    try {
      const LoadedScene scene = load(grid(GetParam(), i % 2 == 0, spoil).json().dump());
      for (const Object& object : scene.scene.objects) {
        const Mesh& mesh = std::get<Mesh>(object.shape);
        for (const auto& corners : mesh.triangles) {
          for (const std::uint32_t corner : corners) ASSERT_LT(corner, mesh.positions.size());
        }
      }
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
    }
  }
}

}  // namespace
}  // namespace microtrace::tests
