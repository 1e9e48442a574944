#include "gltf/asset_builder.hpp"
#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/check/values/accessors.hpp"
#include "io/json/document.hpp"

#include <memory>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using ::testing::ElementsAre;

/// An accessor reader for an asset with one buffer. Owns all objects that must outlive the reader.
class Reading {
 public:
  explicit Reading(const AssetBuilder& asset)
      : text_(asset.with_buffer(nullptr).dump()),
        document_(text_, "test.gltf"),
        asset_(document_),
        model_(io::gltf::parse_model(asset_)),
        buffers_{{.storage = {}, .bytes = asset.buffer}},
        views_(asset_, model_, buffers_),
        reader(asset_, model_, views_) {
    io::gltf::check_accessors(asset_, model_);
  }

 private:
  std::string text_;
  io::JsonDocument document_;
  io::gltf::Asset asset_;
  io::gltf::Model model_;
  std::vector<io::gltf::Buffer> buffers_;
  io::gltf::BufferViews views_;

 public:
  io::gltf::AccessorReader reader;
};

template <typename Number>
int add(AssetBuilder& asset, int type, const char* shape, bool normalized,
        const std::vector<Number>& numbers, std::size_t count, std::size_t stride = 0) {
  return static_cast<int>(
      asset.add("accessors", {{"bufferView", asset.add_view(bytes_of<Number>(numbers), stride)},
                              {"componentType", type},
                              {"normalized", normalized},
                              {"count", count},
                              {"type", shape}}));
}

TEST(GltfAccessorReader, NormalizedIntegersFillTheUnitRange) {
  AssetBuilder asset;
  const int i8_ = add<std::int8_t>(asset, kInt8, "SCALAR", true, {-128, -127, 0, 1, 127}, 5);
  const int u8_ = add<std::uint8_t>(asset, kUint8, "SCALAR", true, {0, 1, 255}, 3);
  const int i16_ = add<std::int16_t>(asset, kInt16, "SCALAR", true, {-32768, -32767, 32767}, 3);
  const int u16_ = add<std::uint16_t>(asset, kUint16, "SCALAR", true, {0, 13107, 65535}, 3);
  Reading reading(asset);
  EXPECT_THAT(reading.reader.read<float>(i8_), ElementsAre(-1, -1, 0, 1 / 127.0F, 1));
  EXPECT_THAT(reading.reader.read<float>(u8_), ElementsAre(0, 1 / 255.0F, 1));
  EXPECT_THAT(reading.reader.read<float>(i16_), ElementsAre(-1, -1, 1));
  EXPECT_THAT(reading.reader.read<float>(u16_), ElementsAre(0, 0.2F, 1));
}

TEST(GltfAccessorReader, OtherIntegersKeepTheirValues) {
  AssetBuilder asset;
  const int bytes = add<std::int8_t>(asset, 5120, "VEC2", false, {-128, 127, 3, -4}, 2);
  const int shorts = add<std::uint16_t>(asset, kUint16, "VEC4", false, {65535, 0, 1, 2}, 1);
  const int joints = add<std::uint8_t>(asset, kUint8, "VEC4", false, {255, 0, 1, 2}, 1);
  Reading reading(asset);
  EXPECT_THAT(reading.reader.read<glm::vec2>(bytes),
              ElementsAre(glm::vec2(-128, 127), glm::vec2(3, -4)));
  EXPECT_THAT(reading.reader.read<glm::vec4>(shorts), ElementsAre(glm::vec4(65535, 0, 1, 2)));
  EXPECT_THAT(reading.reader.read<glm::uvec4>(joints), ElementsAre(glm::uvec4(255, 0, 1, 2)));
}

TEST(GltfAccessorReader, MatricesAreColumnMajor) {
  AssetBuilder asset;
  std::vector<float> numbers;
  for (int i = 0; i < 32; ++i) numbers.push_back(static_cast<float>(i));
  const int matrices = add<float>(asset, kFloat32, "MAT4", false, numbers, 2);
  Reading reading(asset);
  const std::vector<glm::mat4> read = reading.reader.read<glm::mat4>(matrices);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[1][2], glm::vec4(24, 25, 26, 27));
}

TEST(GltfAccessorReader, SelectedElementsEqualThoseOfAFullRead) {
  AssetBuilder asset;
  std::vector<std::int16_t> numbers;  // interleaved: the accessor reads three of every four numbers
  for (int i = 0; i < 400; ++i) numbers.push_back(static_cast<std::int16_t>(i * 80));
  const int accessor = add<std::int16_t>(asset, 5122, "VEC3", true, numbers, 100, 8);
  const std::size_t changed = asset.add_view(bytes_of<std::uint8_t>({0, 7, 50, 99}));
  const std::size_t values =
      asset.add_view(bytes_of<std::int16_t>({-1, -2, -3, -4, -5, -6, -7, -8, -9, -10, -11, -12}));
  asset.json["accessors"][static_cast<std::size_t>(accessor)]["sparse"] = {
      {"count", 4},
      {"indices", {{"bufferView", changed}, {"componentType", kUint8}}},
      {"values", {{"bufferView", values}}}};
  Reading reading(asset);
  const std::vector<Vec3> all = reading.reader.read<Vec3>(accessor);
  ASSERT_EQ(all.size(), 100U);
  EXPECT_EQ(all[1], Vec3(4 * 80, 5 * 80, 6 * 80) / 32767.0F);
  EXPECT_EQ(all[50], Vec3(-7, -8, -9) / 32767.0F);
  const std::vector<std::uint32_t> some = {0, 1, 6, 7, 8, 50, 98, 99};
  std::vector<Vec3> expected;
  for (const std::uint32_t i : some) expected.push_back(all[i]);
  EXPECT_EQ(reading.reader.read<Vec3>(accessor, some), expected);
  std::vector<std::uint32_t> each;
  for (std::uint32_t i = 0; i < 100; ++i) each.push_back(i);
  EXPECT_EQ(reading.reader.read<Vec3>(accessor, each), all);
}

TEST(GltfAccessorReader, ReplacedElementsAreRead) {
  AssetBuilder asset;
  const int accessor =
      add<std::uint8_t>(asset, kUint8, "VEC4", false, std::vector<std::uint8_t>(16), 2, 8);
  Reading reading(asset);
  reading.reader.replace(accessor, bytes_of<std::uint8_t>({1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_THAT(reading.reader.read<glm::uvec4>(accessor),
              ElementsAre(glm::uvec4(1, 2, 3, 4), glm::uvec4(5, 6, 7, 8)));
}

TEST(GltfAccessorReader, ElementsWithoutViewAreZeroAndLimited) {
  AssetBuilder asset;
  asset.add("accessors", {{"componentType", kFloat32}, {"count", 3}, {"type", "VEC2"}});
  asset.add("accessors",
            {{"componentType", kFloat32}, {"count", (1U << 27) + 1}, {"type", "VEC2"}});
  Reading reading(asset);
  EXPECT_THAT(reading.reader.read<glm::vec2>(0),
              ElementsAre(glm::vec2(0), glm::vec2(0), glm::vec2(0)));
  try {
    (void)reading.reader.read<glm::vec2>(1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::limit);
    EXPECT_EQ(error.diagnostic().pointer, "/accessors/1/count");
  }
}

/// An accessor does not include the padding after the last column of its last matrix (glTF 2.0,
/// section 3.6.2.4).
TEST(GltfAccessorReader, LastMatrixOfSmallIntegersNeedsNoPadding) {
  struct Case {
    const char* type;
    int component_type;
    std::size_t bytes;  // size of two matrices
  };
  for (const Case& c :
       {Case{"MAT2", kUint8, 14}, Case{"MAT2", kInt16, 16}, Case{"MAT3", kInt8, 23},
        Case{"MAT3", kUint16, 46}, Case{"MAT4", kUint8, 32}, Case{"MAT2", kFloat32, 32}}) {
    const auto fits = [&](std::size_t size, std::size_t stride) {
      AssetBuilder asset;
      asset.add("accessors", {{"bufferView", asset.add_view(std::string(size, '\0'), stride)},
                              {"componentType", c.component_type},
                              {"count", 2},
                              {"type", c.type}});
      try {
        const Reading reading(asset);
        return true;
      } catch (const Error&) {
        return false;
      }
    };
    EXPECT_TRUE(fits(c.bytes, 0)) << c.type;
    EXPECT_FALSE(fits(c.bytes - 1, 0)) << c.type;
  }
}

TEST(GltfAccessorReader, ElementsBeyondTheEndAreZeros) {
  AssetBuilder asset;
  const int accessor = add<float>(asset, kFloat32, "SCALAR", false, {1, 2, 3}, 3);
  Reading reading(asset);
  const std::vector<std::uint32_t> some = {1, 2, 3, 9}, other = {0, 1, 2, 3, 3};
  EXPECT_THAT(reading.reader.read<float>(accessor, some), ElementsAre(2, 3, 0, 0));
  EXPECT_THAT(reading.reader.read<float>(accessor, other), ElementsAre(1, 2, 3, 0, 0));
}

}  // namespace
}  // namespace microtrace::tests
