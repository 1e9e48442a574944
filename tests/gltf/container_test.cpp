#include "gltf/asset_builder.hpp"

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

void expect_same_cube(const LoadedScene& loaded) {
  ASSERT_EQ(loaded.scene.objects.size(), 1U);
  const Object& object = loaded.scene.objects[0];
  EXPECT_EQ(object.name, "Cube/mesh0");
  EXPECT_EQ(color_of(loaded, 0), Vec4(1, 0.25F, 0.125F, 1));
  EXPECT_EQ(triangles_of(object), triangles_of(load(cube()).scene.objects[0]));
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
}

TEST(GltfContainer, EmbeddedAndBinaryFilesHoldTheSameCube) {
  const LoadedScene loaded = load(cube().embedded());
  ASSERT_EQ(loaded.scene.objects.size(), 1U);
  const auto triangles = triangles_of(loaded.scene.objects[0]);
  ASSERT_EQ(triangles.size(), 12U);
  EXPECT_EQ(triangles[0], (std::array{Vec3(-1, -1, -1), Vec3(-1, 1, -1), Vec3(1, -1, -1)}));
  expect_same_cube(loaded);
  expect_same_cube(load(cube().glb()));
}

TEST(GltfContainer, UnknownChunksAreSkipped) {
  const std::string json = padded(cube().with_buffer(nullptr).dump(), ' ');
  expect_same_cube(load(glb_file({{json_chunk, json},
                                  {bin_chunk, padded(cube().buffer, '\0')},
                                  {0x12345678, "whatever"},
                                  {0x12345678, ""}})));
}

TEST(GltfContainer, PercentEncodedDataUriHoldsTheSameCube) {
  std::string encoded = "data:application/gltf-buffer,";
  for (const char byte : cube().buffer) {
    constexpr std::string_view digits = "0123456789aBcDeF";
    const auto value = static_cast<unsigned char>(byte);
    encoded += {'%', digits[value / 16], digits[value % 16]};
  }
  expect_same_cube(load(cube().with_buffer(encoded.c_str()).dump()));
}

TEST(GltfContainer, MessagesAboutABinaryFileNameItsJsonChunk) {
  AssetBuilder asset = cube();
  asset.json["scene"] = 7;
  try {
    (void)load(asset.glb());
    FAIL() << "accepted a scene out of range";
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostic().file, "test.gltf (JSON chunk)");
    EXPECT_EQ(error.diagnostic().line, 1U);
    EXPECT_EQ(error.diagnostic().pointer, "/scene");
  }
}

TEST(GltfContainer, BytesAfterTheEndAreIgnoredWithAWarning) {
  EXPECT_THAT(texts(load(cube().glb() + "xyz").warnings),
              testing::ElementsAre(": 3 bytes after the end of the GLB file are ignored"));
}

TEST(GltfContainer, ChunksOfUnalignedLengthAreReadWithAWarning) {
  std::string json = cube().with_buffer(nullptr).dump();
  json.resize(json.size() / 4 * 4 + 5, ' ');
  const std::string bin = padded(cube().buffer, '\0');
  const LoadedScene loaded = load(glb_file({{json_chunk, json}, {bin_chunk, bin}}));
  EXPECT_EQ(loaded.scene.objects.size(), 1U);
  EXPECT_THAT(texts(loaded.warnings), testing::Contains(HasSubstr("no multiples of 4")));
}

struct BadFile {
  const char* name;
  std::string bytes;
  ErrorKind kind;
  const char* message;
};

std::vector<BadFile> bad_files() {
  const std::string json = padded(cube().with_buffer(nullptr).dump(), ' ');
  const std::string bin = padded(cube().buffer, '\0');
  const std::string good = cube().glb();
  std::string wrong_length = good;
  wrong_length[8] = static_cast<char>(wrong_length[8] + 4);
  std::string no_length = good;
  no_length.replace(8, 4, 4, '\0');
  std::string long_chunk = good;
  long_chunk[15] = 0x7F;
  constexpr auto invalid = ErrorKind::invalid_scene;
  return {
      {"empty", "", invalid, "empty"},
      {"magic only", "glTF", invalid, "cut off"},
      {"header only", good.substr(0, 12), invalid, "cut off"},
      {"half", good.substr(0, good.size() / 2), invalid, "cut off"},
      {"last byte missing", good.substr(0, good.size() - 1), invalid, "cut off"},
      {"container version 1", glb_file({{json_chunk, json}}, 1), ErrorKind::unsupported, "version"},
      {"length beyond the file", wrong_length, invalid, "cut off"},
      {"length less than the header", no_length, invalid, "less than"},
      {"chunk longer than the file", long_chunk, invalid, "claims"},
      {"BIN first", glb_file({{bin_chunk, bin}, {json_chunk, json}}), invalid, "first chunk"},
      {"BIN third", glb_file({{json_chunk, json}, {7, "1234"}, {bin_chunk, bin}}), invalid,
       "second"},
      {"two BIN", glb_file({{json_chunk, json}, {bin_chunk, bin}, {bin_chunk, bin}}), invalid,
       "second"},
      {"two JSON", glb_file({{json_chunk, json}, {json_chunk, json}}), invalid, "two JSON"},
      {"empty JSON", glb_file({{json_chunk, ""}, {bin_chunk, bin}}), invalid, "empty"},
      {"byte order mark", "\xEF\xBB\xBF" + json, invalid, "byte order mark"},
      {"byte order mark in a chunk", glb_file({{json_chunk, "\xEF\xBB\xBF " + json}}), invalid,
       "byte order mark"},
      {"chunk header cut", glb_file({{json_chunk, json}}) + "1234", invalid, ""},
      {"not JSON", "{\"asset\":", invalid, ""},
      {"an array", "[1, 2, 3]", invalid, "object"},
  };
}

TEST(GltfContainer, BrokenFilesAreRefused) {
  for (const BadFile& file : bad_files()) {
    SCOPED_TRACE(file.name);
    std::string bytes = file.bytes;
    if (std::string_view(file.name) == "chunk header cut") {
      bytes[8] = static_cast<char>(bytes[8] + 4);  // the file's length includes the stray bytes
    }
    try {
      (void)load(bytes);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), file.kind) << error.what();
      EXPECT_THAT(error.diagnostic().message, HasSubstr(file.message));
    }
  }
}

}  // namespace
}  // namespace microtrace::tests
