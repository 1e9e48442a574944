#include "gltf/rig.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A change to numbers in the rig's accessors, and the expected message.
struct Poke {
  std::function<void(AssetBuilder&)> change;
  const char* pointer;
  const char* message;
};

template <typename Number>
std::function<void(AssetBuilder&)> set(RigAccessor accessor, std::size_t number, Number value) {
  return [=](AssetBuilder& asset) { poke(asset, accessor, number, value); };
}

/// Adds a sparse part with two elements to an accessor.
std::function<void(AssetBuilder&)> sparse(RigAccessor accessor, std::uint16_t first,
                                          std::uint16_t second, float value) {
  return [=](AssetBuilder& asset) {
    const std::size_t indices = asset.add_view(bytes_of<std::uint16_t>({first, second}));
    const std::size_t values = asset.add_view(bytes_of<float>(std::vector<float>(8, value)));
    asset.json["accessors"][accessor]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", indices}, {"componentType", kUint16}}},
        {"values", {{"bufferView", values}}}};
  };
}

const Poke refused[] = {
    {set<std::uint8_t>(rig_joints, 5, 2), "/meshes/0/primitives/0/attributes/JOINTS_0",
     "vertex 1 refers to joint 2 of a skin of only 2"},
    {sparse(rig_texcoords, 1, 1, 0), "/accessors/3/sparse/indices", "item 1 is 1"},
    {sparse(rig_texcoords, 1, 3, 0), "/accessors/3/sparse/indices", "item 1 is 3"},
};

const Poke survived[] = {
    {set<std::uint8_t>(rig_joints, 7, 9), "/meshes/0/primitives/0/attributes/JOINTS_0",
     "1 times to joints that the skin does not have, with a weight of 0"},
    {set(rig_positions, 4, NAN), "/accessors/0", "element 1 is not finite"},
    {set(rig_normals, 8, kInfinity), "/accessors/1", "element 2 is not finite"},
    {set(rig_weights, 0, -kInfinity), "/accessors/6", "element 0 is not finite"},
    {set(rig_matrices, 31, NAN), "/accessors/9", "element 1 is not finite"},
    {set(rig_translations, 5, NAN), "/accessors/11", "element 1 is not finite"},
    {set(rig_times, 1, 0.0F), "/accessors/10", "element 1 is not greater"},
    {set(rig_times, 0, 2.0F), "/accessors/10", "element 1 is not greater"},
    {sparse(rig_texcoords, 1, 2, NAN), "/accessors/3", "element 1 is not finite"},
    {[](AssetBuilder& asset) {
       asset.json["meshes"][0]["primitives"][0]["attributes"].erase("POSITION");
       asset.json["meshes"][0]["primitives"][0].erase("targets");
       asset.json["animations"][0]["channels"].erase(2);
       poke<std::uint16_t>(asset, rig_indices, 2, 3);
     },
     "/accessors/8", "has indices beyond the 3 vertices"},
    {[](AssetBuilder& asset) {
       asset.add_object(
           {{"attributes", Json::object()}, {"indices", asset.add_indices({0, 0, 0}, kUint8)}});
     },
     "/accessors/14", "has indices beyond the 0 vertices"},
    {[](AssetBuilder& asset) {
       asset.json["accessors"][rig_positions]["min"] = {0, 0, 0.5};
     },
     "/accessors/0/min", "is not the least"},
    {[](AssetBuilder& asset) { asset.json["accessors"][rig_indices]["max"] = {7}; },
     "/accessors/8/max", "is not the greatest"},
    {set(rig_normals, 2, 2.0F), "/accessors/1", "1 of its elements are not unit vectors"},
    {set(rig_tangents, 0, 0.5F), "/accessors/2", "1 of its elements are not unit vectors"},
    {set(rig_tangents, 3, 0.0F), "/accessors/2", "1 of its tangents have a w"},
    {set(rig_colors, 4, 1.5F), "/accessors/4", "1 of its colors are not between"},
    {set(rig_weights, 0, -0.5F), "/meshes/0/primitives/0/attributes/WEIGHTS_0", "negative"},
    {set(rig_weights, 0, 0.25F), "/meshes/0/primitives/0/attributes/WEIGHTS_0", "add up to 1"},
    {set<std::uint8_t>(rig_joints, 1, 0), "/meshes/0/primitives/0/attributes/WEIGHTS_0", "twice"},
    {set(rig_matrices, 15, 2.0F), "/accessors/9", "1 of its matrices do not have the last row"},
    {set(rig_times, 0, -1.0F), "/accessors/10", "1 of its times are negative"},
    {set(rig_rotations, 3, 0.5F), "/accessors/12", "1 of its rotations are not unit"},
};

// Integers are normalized before their length is checked.
TEST(GltfData, QuantizedDirectionsMustBeOfUnitLength) {
  const auto warnings_of = [](const auto& normals, bool of_bytes) {
    AssetBuilder asset = rig();
    asset.json["extensionsUsed"] = asset.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    Json& normal = asset.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"];
    normal = of_bytes ? asset.add_numbers<std::int8_t>("VEC3", normals.first, true)
                      : asset.add_numbers<std::int16_t>("VEC3", normals.second, true);
    return texts(load(asset).warnings);
  };
  using Bytes = std::vector<std::int8_t>;
  using Words = std::vector<std::int16_t>;
  const auto fine = std::pair{Bytes{73, 73, 73, -128, 0, 0, 0, 90, 90},
                              Words{18918, 18918, 18918, -32768, 0, 0, 0, 23170, 23170}};
  const auto half =
      std::pair{Bytes{64, 0, 0, 0, 127, 0, 0, 0, 0}, Words{16384, 0, 0, 0, 32767, 0, 0, 0, 0}};
  for (const bool of_bytes : {true, false}) {
    const auto complaint = Contains(HasSubstr("2 of its elements are not unit vectors"));
    EXPECT_THAT(warnings_of(fine, of_bytes), testing::Not(Contains(HasSubstr("unit vectors"))));
    EXPECT_THAT(warnings_of(half, of_bytes), complaint);
  }
}

TEST(GltfData, InvalidNumbersAreRefused) {
  for (const Poke& poke : refused) {
    SCOPED_TRACE(poke.message);
    AssetBuilder asset = rig();
    poke.change(asset);
    try {
      (void)load(asset);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene) << error.what();
      EXPECT_EQ(error.diagnostic().pointer, poke.pointer) << error.what();
      EXPECT_THAT(error.diagnostic().message, HasSubstr(poke.message));
    }
  }
}

TEST(GltfData, SuspiciousNumbersGiveWarnings) {
  for (const Poke& poke : survived) {
    SCOPED_TRACE(poke.message);
    AssetBuilder asset = rig();
    poke.change(asset);
    EXPECT_THAT(
        texts(load(asset).warnings),
        Contains(AllOf(HasSubstr(std::string(poke.pointer) + ": "), HasSubstr(poke.message))));
  }
}

TEST(GltfData, OverlappingAccessorsAreLimited) {
  AssetBuilder asset = cube();
  const std::size_t view = asset.add_view(std::string(1 << 16, '\0'));
  for (int i = 0; i <= 1 << 16; ++i) {
    asset.add(
        "accessors",
        {{"bufferView", view}, {"componentType", kUint32}, {"count", 1 << 14}, {"type", "SCALAR"}});
  }
  try {
    (void)load(asset);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::limit);
  }
}

TEST(GltfData, VerticesMayHaveAnyStride) {
  const auto expected = triangles_of(load(cube()).scene.objects.at(0));
  for (const std::size_t stride : {13, 14, 255, 300}) {
    AssetBuilder asset = cube();
    std::string bytes;
    for (std::size_t i = 0; i < 8; ++i)
      bytes += asset.buffer.substr(12 * i, 12) + std::string(stride - 12, 'x');
    asset.json["accessors"][0]["bufferView"] = asset.add_view(bytes, stride);
    const LoadedScene loaded = load(asset);
    EXPECT_EQ(triangles_of(loaded.scene.objects.at(0)), expected) << stride;
    EXPECT_THAT(texts(loaded.warnings),
                testing::Contains(testing::HasSubstr("byteStride: must be a multiple of 4")));
  }
}

}  // namespace
}  // namespace microtrace::tests
