#include "gltf/asset_builder.hpp"
#include "io/gltf/scene/scene.hpp"

#include <fstream>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::HasSubstr;

constexpr auto kInvalid = ErrorKind::invalid_scene;
constexpr auto kUnsupported = ErrorKind::unsupported;
constexpr auto kLimit = ErrorKind::limit;

/// A change to the cube's JSON, as made by mutated().
struct Mutation {
  const char* where;
  const char* value;
  ErrorKind kind = kInvalid;
  const char* pointer = nullptr;  ///< pointer in the message; null if equal to `where`
};

// Accessor 0 of the cube has 8 positions (96 bytes), accessor 1 has 36 indices (72 bytes).
const Mutation kMalformed[] = {
    // The asset as a whole
    {"/asset", "", kInvalid, ""},
    {"/asset", "[]", kInvalid},
    {"/asset/version", "", kInvalid, "/asset"},
    {"/asset/version", "2.0"},
    {"/asset/version", "\"two\""},
    {"/asset/version", "\"2\""},
    {"/asset/version", "\"2.0.1\""},
    {"/asset/version", "\"1.0\"", kUnsupported},
    {"/asset/version", "\"3.0\"", kUnsupported},
    {"", R"({"extensionsUsed": ["MSFT_texture_dds"],
             "extensionsRequired": ["MSFT_texture_dds"]})",
     kUnsupported, "/extensionsRequired/0"},
    {"", R"({"extensionsUsed": ["X_a/b~c"],
             "extensionsRequired": ["KHR_materials_unlit", "X_a/b~c"]})",
     kUnsupported, "/extensionsRequired/1"},
    {"/extensionsRequired", "[1]", kInvalid, "/extensionsRequired/0"},
    {"/extensions", "[]"},
    {"/nodes/0/extensions", R"({"X": 1})", kInvalid, "/nodes/0/extensions/X"},
    {"/nodes", "{}"},
    {"/nodes/0", "0"},
    {"/nodes/0/name", "7"},

    // Indices into arrays
    {"/scene", "1"},
    {"/scene", "-1"},
    {"/scene", "0.5"},
    {"/scene", "\"0\""},
    {"/scene", "1e300"},
    {"/scenes/0/nodes/0", "1"},
    {"/nodes/0/mesh", "1"},
    {"/nodes/0/camera", "0"},
    {"/nodes/0/skin", "0"},
    {"/meshes/0/primitives/0/indices", "2"},
    {"/meshes/0/primitives/0/material", "1"},
    {"/meshes/0/primitives/0/attributes/POSITION", "2"},
    {"/accessors/0/bufferView", "2"},
    {"/bufferViews/0/buffer", "1"},
    {"/images", R"([{"bufferView": 9}])", kInvalid, "/images/0/bufferView"},
    {"/textures", R"([{"source": 0}])", kInvalid, "/textures/0/source"},
    {"/materials/0/normalTexture", R"({"index": 0})", kInvalid, "/materials/0/normalTexture/index"},

    // Buffers and views
    {"/buffers/0/byteLength", "0", kInvalid, "/bufferViews/0"},
    {"/buffers/0/byteLength", "172"},
    {"/buffers/0/byteLength", "167", kInvalid, "/bufferViews/1"},
    {"/buffers/0/byteLength", "9007199254740992", kLimit},
    {"/buffers/0/byteLength", "", kInvalid, "/buffers/0"},
    {"/bufferViews/0/byteLength", "95", kInvalid, "/accessors/0"},
    {"/bufferViews/1/byteLength", "73", kInvalid, "/bufferViews/1"},
    {"/bufferViews/1/byteOffset", "97", kInvalid, "/bufferViews/1"},
    {"/bufferViews/1/byteOffset", "9007199254740992", kInvalid, "/bufferViews/1"},
    {"/bufferViews/1/byteOffset", "1e300"},
    {"/bufferViews/0/byteLength", "0", kInvalid, "/accessors/0"},
    {"/bufferViews/0/byteStride", "-4"},
    {"/bufferViews/0/byteStride", "3", kInvalid, "/accessors/0"},
    {"/bufferViews/0/byteStride", "14", kInvalid, "/accessors/0"},
    {"/bufferViews/0/byteStride", "256"},
    {"/bufferViews/0/byteStride", "100"},
    {"/bufferViews/0/byteStride", "8", kInvalid, "/accessors/0"},
    {"/bufferViews/0/byteStride", "16", kInvalid, "/accessors/0"},
    {"/bufferViews/1/byteStride", "4", kInvalid, "/accessors/1"},  // the last would lie outside

    // Accessors
    {"/accessors/0/count", "9", kInvalid, "/accessors/0"},
    {"/accessors/0/count", "-1"},
    {"/accessors/0/count", "9007199254740992", kInvalid, "/accessors/0"},
    {"/accessors/0/byteOffset", "4", kInvalid, "/accessors/0"},
    {"/accessors/0/byteOffset", "-4"},
    {"/accessors/0/normalized", "1"},
    {"/accessors/1/type", "\"VEC2\"", kInvalid, "/meshes/0/primitives/0/indices"},
    {"/accessors/1/componentType", "5122", kInvalid, "/meshes/0/primitives/0/indices"},
    {"/accessors/1/componentType", "5125", kInvalid, "/accessors/1"},
    {"/accessors/1", R"({"componentType": 5125, "count": 9007199254740992, "type": "SCALAR"})",
     kLimit, "/meshes/0/primitives/0/indices"},

    // Sparse accessors
    {"/accessors/0/sparse", R"({"count": 1})"},
    {"/accessors/0/sparse",
     R"({"count": 9, "indices": {"bufferView": 1, "componentType": 5123},
         "values": {"bufferView": 0}})",
     kInvalid, "/accessors/0/sparse/count"},
    {"/accessors/0/sparse",
     R"({"count": 1, "indices": {"bufferView": 1, "componentType": 5122},
         "values": {"bufferView": 0}})",
     kInvalid, "/accessors/0/sparse/indices/componentType"},
    {"/accessors/0/sparse",  // the indices 0, 2, 1 are not increasing
     R"({"count": 3, "indices": {"bufferView": 1, "componentType": 5123},
         "values": {"bufferView": 0}})",
     kInvalid, "/accessors/0/sparse/indices"},
    {"/accessors/0/sparse",  // reads two u16 indices as one u32, which exceeds the count
     R"({"count": 1, "indices": {"bufferView": 1, "byteOffset": 4, "componentType": 5125},
         "values": {"bufferView": 0}})",
     kInvalid, "/accessors/0/sparse/indices"},
    {"/accessors/0/sparse",
     R"({"count": 1, "indices": {"bufferView": 1, "byteOffset": 72, "componentType": 5123},
         "values": {"bufferView": 0}})",
     kInvalid, "/accessors/0/sparse/indices"},
    {"/accessors/0/sparse",
     R"({"count": 1, "indices": {"bufferView": 1, "componentType": 5123},
         "values": {"bufferView": 0, "byteOffset": 88}})",
     kInvalid, "/accessors/0/sparse/values"},

    // Meshes and materials
    {"/meshes/0/primitives", "", kInvalid, "/meshes/0"},
    {"/meshes/0/primitives/0/attributes", "", kInvalid, "/meshes/0/primitives/0"},
    {"/meshes/0/primitives/0/mode", "7"},
    {"/materials/0/doubleSided", "0"},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1, 1]"},

    // Nodes
    {"/nodes/0/children", "[0]", kInvalid, "/nodes/0/children/0"},
    {"/nodes", R"([{"children": [1]}, {"children": [0]}])", kInvalid, "/nodes/0"},
    {"/nodes", R"([{}, {"children": [2]}, {"children": [1]}])", kInvalid, "/nodes/1"},
    {"/nodes", R"([{"children": [1]}, {}, {"children": [1]}])", kInvalid, "/nodes/2/children/0"},
    {"/nodes", R"([{"children": [1, 1]}, {}])", kInvalid, "/nodes/0/children/1"},
    {"/nodes/0/matrix", "[1, 0, 0]"},
    {"/nodes/0/translation", "[1, 2]"},
    {"/nodes/0/scale", R"([1, "2", 3])", kInvalid, "/nodes/0/scale/1"},

    // Cameras
    {"/cameras", R"([{"type": "perspective", "perspective": {"yfov": 1}}])", kInvalid,
     "/cameras/0/perspective"},

    // URIs and images
    {"/buffers/0/uri", "\"cube.bin\""},
    {"/buffers/0/uri", "\".\""},
    {"/buffers/0/uri", "\"../cube.bin\""},
    {"/buffers/0/uri", "\"/dev/zero\""},
    {"/buffers/0/uri", "\"%2e%2e/cube.bin\""},
    {"/buffers/0/uri", "\"file:cube.bin\""},
    {"/buffers/0/uri", "\"https://example.org/cube.bin\""},
    {"/buffers/0/uri", "\"a\\\\b\""},
    {"/buffers/0/uri", "\"..\\\\cube.bin\""},
    {"/buffers/0/uri", "\"%2e.%5ccube.bin\""},
    {"/buffers/0/uri", "\"\\\\cube.bin\""},
    {"/buffers/0/uri", "\"a\\u0000\""},
    {"/buffers/0/uri", "\"\""},
    {"/buffers/0/uri", "\"data:application/octet-stream;base64,AAA=A\""},
    {"/buffers/0/uri", "\"data:application/octet-stream;base64,AAAA\"", kInvalid,
     "/buffers/0/byteLength"},
    {"/buffers/0/uri", "\"data:application/octet-stream;base64\""},
    {"/buffers/0/uri", "7"},
    {"/images", R"([{}])", kInvalid, "/images/0"},
};

TEST(GltfMalformed, EveryMutationIsRefusedAtItsPointer) {
  for (const Mutation& mutation : kMalformed) {
    SCOPED_TRACE(std::string(mutation.where) + " = " + mutation.value);
    try {
      (void)load(mutated(cube(), mutation.where, mutation.value));
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), mutation.kind) << error.what();
      EXPECT_EQ(error.diagnostic().pointer,
                mutation.pointer != nullptr ? mutation.pointer : mutation.where)
          << error.what();
      EXPECT_EQ(error.diagnostic().file, "test.gltf");
      EXPECT_GT(error.diagnostic().line, 0U);
      EXPECT_THAT(error.diagnostic().excerpt, HasSubstr("^"));
    }
  }
}

TEST(GltfMalformed, IndexOutOfRangeIsRefused) {
  for (const auto& [type, last, message] :
       {std::tuple{kUint8, 3U, "vertex 3 of only 3"},
        std::tuple{kUint16, 65534U, "vertex 65534 of only 3"},
        std::tuple{kUint32, 0xFFFFU, "vertex 65535 of only 3"}}) {
    AssetBuilder asset;
    const std::size_t positions = asset.add_positions({Vec3(0), Vec3(1), Vec3(2)});
    const std::size_t indices = asset.add_indices({0, 1, last}, type);
    // Strips of lines are checked like triangles.
    asset.add_object(
        {{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"mode", 3}});
    try {
      (void)load(asset);
      ADD_FAILURE() << "accepted " << last;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kInvalid);
      EXPECT_EQ(error.diagnostic().pointer, "/accessors/1");
      EXPECT_THAT(error.diagnostic().message, HasSubstr(message));
    }
  }
}

TEST(GltfMalformed, MissingBufferNamesItsPath) {
  try {
    (void)load(cube().with_buffer("sub/no%20such.bin").dump());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.diagnostic().message, HasSubstr("nowhere/sub/no such.bin"));
  }
}

TEST(GltfMalformed, TooManyInstancesAreRefusedBeforeAllocation) {
  AssetBuilder asset;
  const std::size_t positions = asset.add_positions({Vec3(0), Vec3(1), Vec3(2)});
  const std::size_t indices =
      asset.add("accessors", {{"componentType", kUint8}, {"count", 3 << 16}, {"type", "SCALAR"}});
  asset.add_object({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  for (std::size_t i = 1; i <= 2048; ++i) {
    asset.json["nodes"].push_back({{"mesh", 0}});
    asset.json["scenes"][0]["nodes"].push_back(i);
  }
  try {
    (void)load(asset, {.instancing = Instancing::copied});
    FAIL() << "accepted 2049 * 2^16 triangles";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kLimit);
    EXPECT_EQ(error.diagnostic().pointer, "/nodes/2048/mesh");
  }
  EXPECT_EQ(load(asset).scene.objects.size(), 2049U);  // shared
  for (std::size_t i = 2049; i < 65536; ++i) {
    asset.json["nodes"].push_back({{"mesh", 0}});
    asset.json["scenes"][0]["nodes"].push_back(i);
  }
  try {
    (void)load(asset);
    FAIL() << "accepted 2^32 triangles";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kLimit);
    EXPECT_EQ(error.diagnostic().pointer, "/nodes/65535/mesh");
  }
}

/// Whichever single byte of a file is changed, loading must either succeed or throw an Error.
TEST(GltfMalformed, AnyByteOfABinaryFileMayBeDamaged) {
  const std::string good = cube().glb();
  std::size_t refused = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const char byte : {'\0', '\xFF', '"', '9', '}'}) {
      std::string bad = good;
      bad[i] = byte;
      try {
        (void)load(bad);
      } catch (const Error& error) {
        EXPECT_NE(error.kind(), ErrorKind::internal) << error.what();
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, good.size());
}

}  // namespace
}  // namespace microtrace::tests
