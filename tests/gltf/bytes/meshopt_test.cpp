#include "gltf/asset_builder.hpp"
#include "io/gltf/bytes/meshopt_filters.hpp"

#include <cmath>
#include <cstring>
#include <functional>
#include <meshoptimizer.h>
#include <random>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kExtension = "EXT_meshopt_compression";

std::string text_of(const std::vector<unsigned char>& bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes.data()), size};
}

std::string encoded_attributes(const std::string& bytes, std::size_t stride) {
  const std::size_t count = bytes.size() / stride;
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
  return text_of(out,
                 meshopt_encodeVertexBuffer(out.data(), out.size(), bytes.data(), count, stride));
}

std::string encoded_triangles(const std::vector<unsigned>& indices) {
  meshopt_encodeIndexVersion(1);
  std::vector<unsigned char> out(meshopt_encodeIndexBufferBound(indices.size(), 1000));
  return text_of(out,
                 meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
}

std::string encoded_indices(const std::vector<unsigned>& indices) {
  std::vector<unsigned char> out(meshopt_encodeIndexSequenceBound(indices.size(), 1000));
  return text_of(
      out, meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
}

/// An asset whose views are compressed in buffer 0. Buffer 1 stands for the uncompressed data and
/// has no bytes.
struct CompressedAsset {
  AssetBuilder asset;
  std::size_t uncompressed = 0;  // size of buffer 1 in bytes

  CompressedAsset() {
    asset.json["extensionsUsed"] =
        asset.json["extensionsRequired"] = {kExtension, "KHR_mesh_quantization"};
  }

  std::size_t add_view(const std::string& bytes, const char* mode, std::size_t count,
                       std::size_t stride, const char* filter = nullptr) {
    const std::size_t view = asset.add_view(bytes);
    Json& json = asset.json["bufferViews"][view];
    Json compression = json;
    compression.update({{"mode", mode}, {"count", count}, {"byteStride", stride}});
    if (filter != nullptr) compression["filter"] = filter;
    json = {{"buffer", 1},
            {"byteOffset", uncompressed},
            {"byteLength", count * stride},
            {"extensions", {{kExtension, compression}}}};
    if (std::string(mode) == "ATTRIBUTES") json["byteStride"] = stride;
    uncompressed += (count * stride + 3) / 4 * 4;
    return view;
  }

  std::size_t add_accessor(std::size_t view, int type, const char* shape, std::size_t count,
                           bool normalized = false) {
    return asset.add("accessors", {{"bufferView", view},
                                   {"componentType", type},
                                   {"normalized", normalized},
                                   {"count", count},
                                   {"type", shape},
                                   {"min", Json::array({0, 0, 0})},
                                   {"max", Json::array({0, 0, 0})}});
  }

  [[nodiscard]] Json json() const {
    Json result = Json::parse(asset.embedded());
    result["buffers"].push_back(
        {{"byteLength", uncompressed}, {"extensions", {{kExtension, {{"fallback", true}}}}}});
    for (Json& accessor : result["accessors"]) {
      if (accessor["type"] != "VEC3") accessor.erase("min"), accessor.erase("max");
    }
    return result;
  }
};

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
CompressedAsset grid(bool triangles, const std::function<void(std::string&)>& spoil = {}) {
  CompressedAsset result;
  const std::vector<std::int16_t> positions = grid_positions();
  const std::vector<unsigned> corners = grid_triangles();
  std::string vertices = encoded_attributes(bytes_of(positions), 8);
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

TEST(GltfMeshopt, TrianglesAndAttributesAreDecoded) {
  const LoadedScene scene = load(grid(true).json().dump());
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

TEST(GltfMeshopt, IndexSequencesAreDecoded) {
  const LoadedScene scene = load(grid(false).json().dump());
  const Mesh& mesh = std::get<Mesh>(scene.scene.objects.at(0).shape);
  const std::vector<unsigned> corners = grid_triangles();
  ASSERT_EQ(mesh.segments.size() + 1, corners.size());
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) {
    EXPECT_EQ(mesh.segments[i], (std::array<std::uint32_t, 2>{corners[i], corners[i + 1]}));
  }
}

TEST(GltfMeshopt, ExponentialFilterGivesFloats) {
  CompressedAsset asset;
  const auto exponential = [](int exponent, int mantissa) {
    return static_cast<std::uint32_t>(exponent) << 24U |
           (static_cast<std::uint32_t>(mantissa) & 0xFFFFFFU);
  };
  const std::vector<std::uint32_t> words = {
      exponential(0, 3),  exponential(-1, 5), exponential(-2, -1),
      exponential(1, -7), exponential(10, 1), exponential(-20, 0),
      exponential(0, 0),  exponential(0, 1),  exponential(-23, 1)};
  const std::size_t view =
      asset.add_view(encoded_attributes(bytes_of(words), 12), "ATTRIBUTES", 3, 12, "EXPONENTIAL");
  asset.asset.add_object(
      {{"attributes", {{"POSITION", asset.add_accessor(view, kFloat32, "VEC3", 3)}}}});
  EXPECT_THAT(triangles_of(load(asset.json().dump()).scene.objects.at(0)),
              ElementsAre(std::array{Vec3(3, 2.5, -0.25), Vec3(-14, 1024, 0),
                                     Vec3(0, 1, 1.1920928955078125e-07F)}));
}

template <typename Number>
std::vector<Number> filtered(const std::vector<Number>& numbers,
                             const std::function<void(std::string&)>& filter) {
  std::string bytes = bytes_of(numbers);
  filter(bytes);
  std::vector<Number> result(numbers.size());
  std::memcpy(result.data(), bytes.data(), bytes.size());
  return result;
}

TEST(GltfMeshopt, OctahedralFilterGivesUnitVectors) {
  const auto decode8 = [](std::string& bytes) { io::gltf::decode_octahedral(bytes, 4); };
  EXPECT_THAT(filtered<std::int8_t>({0, 0, 127, 5, 127, 0, 127, 6, 0, -127, 127, -7}, decode8),
              ElementsAre(0, 0, 127, 5, 127, 0, 0, 6, 0, -127, 0, -7));
  // The lower pole maps to every corner of the square.
  EXPECT_THAT(filtered<std::int8_t>({7, 7, 7, 0, -7, 7, 7, 0}, decode8),
              ElementsAre(0, 0, -127, 0, 0, 0, -127, 0));
  const auto decode16 = [](std::string& bytes) { io::gltf::decode_octahedral(bytes, 8); };
  EXPECT_THAT(filtered<std::int16_t>({0, 0, 511, 3, 0, 511, 511, -4}, decode16),
              ElementsAre(0, 0, 32767, 3, 0, 32767, 0, -4));
  // Meaningless input must not cause undefined behavior.
  (void)filtered<std::int16_t>({1, -1, 0, 3, -32768, 32767, -1, 0, 0, 0, 0, 0}, decode16);
}

TEST(GltfMeshopt, QuaternionFilterRestoresTheLargestComponent) {
  // The last number of each quaternion is 2047, the maximum of 12 bits, except for its two low
  // bits. These are the index of the largest component: 3 and 1.
  const std::vector<std::int16_t> stored = {0, 0, 0, 2047, 2047, 0, 0, 2045, 0, 0, 0, 0};
  const auto decoded = filtered<std::int16_t>(stored, io::gltf::decode_quaternions);
  EXPECT_THAT(std::vector(decoded.begin(), decoded.begin() + 4), ElementsAre(0, 0, 0, 32767));
  EXPECT_THAT(std::vector(decoded.begin() + 4, decoded.begin() + 8),
              ElementsAre(0, 23170, 23170, 0));
}

TEST(GltfMeshopt, FiltersEqualThoseOfTheLibraryUpToRounding) {
  std::mt19937 random(3);
  std::vector<std::int16_t> stored;
  for (int i = 0; i < 2000; ++i) {
    const int x = static_cast<int>(random() % 1023) - 511;
    const int y = static_cast<int>(random() % 1023) - 511;
    for (const int v : {x, y * (511 - std::abs(x)) / 511, 511, i}) {
      stored.push_back(static_cast<std::int16_t>(v));
    }
  }
  std::vector<std::int16_t> theirs = stored;
  meshopt_decodeFilterOct(theirs.data(), 2000, 8);
  const std::vector<std::int16_t> ours = filtered<std::int16_t>(
      stored, [](std::string& bytes) { io::gltf::decode_octahedral(bytes, 8); });
  for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(ours[i], theirs[i], 1) << i;
}

TEST(GltfMeshopt, ViolationsOfTheExtensionAreRefused) {
  struct Case {
    std::size_t view;
    Json change;  // members of the extension object to change
    const char* message;
  };
  const std::vector<Case> cases = {
      {0, {{"byteStride", 12}}, "byteStride"},
      {0, {{"count", 100}}, "gives the view"},
      {0, {{"filter", "QUATERNIONS"}}, ""},
      {0, {{"byteLength", 1 << 20}}, "beyond its buffer"},
      {0, {{"byteLength", 1}}, "bytes"},
      {0, {{"byteOffset", 1e15}}, "beyond its buffer"},
      {0, {{"mode", "TRIANGLES"}}, "byteStride 2 or 4"},
      {0, {{"mode", "SOMETHING"}}, ""},
      {1, {{"mode", "ATTRIBUTES"}}, "multiple of 4"},
      {1, {{"filter", "OCTAHEDRAL"}}, "filter"},
      {1, {{"buffer", 7}}, ""},
  };
  for (const Case& c : cases) {
    Json json = grid(true).json();
    json["bufferViews"][c.view]["extensions"][kExtension].update(c.change);
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

TEST(GltfMeshopt, AttributesOfVersion1AreNamed) {
  const Json json = grid(true, [](std::string& bytes) {
                      if (bytes[0] == '\xa0') bytes[0] = '\xa1';
                    }).json();
  try {
    (void)load(json.dump());
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostic().pointer, "/bufferViews/0/extensions/EXT_meshopt_compression");
    EXPECT_THAT(error.diagnostic().message, HasSubstr("attributes of version 1"));
  }
}

TEST(GltfMeshopt, CountsBeyondTheDataAreRefusedBeforeAllocation) {
  Json json = grid(true).json();
  const double count = 4e8;
  json["bufferViews"][0]["byteLength"] = json["buffers"][1]["byteLength"] = count * 8;
  json["bufferViews"][0]["byteOffset"] = 0;
  json["bufferViews"][0]["extensions"][kExtension]["count"] = count;
  try {
    (void)load(json.dump());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.diagnostic().message, HasSubstr("more elements than its bytes can hold"));
  }
}

TEST(GltfMeshopt, DamagedDataGivesErrorsOrValidMeshes) {
  std::mt19937 random(4);
  for (int i = 0; i < 1500; ++i) {
    const auto spoil = [&random](std::string& bytes) {
      if (random() % 4 == 0) bytes.resize(1 + random() % bytes.size());
      for (unsigned k = random() % 4; k > 0; --k) {
        bytes[random() % bytes.size()] = static_cast<char>(random());
      }
    };
    try {
      const LoadedScene scene = load(grid(i % 2 == 0, spoil).json().dump());
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
