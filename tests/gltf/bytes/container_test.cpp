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

TEST(GltfContainer, EmbeddedAndBinaryFilesGiveTheSameCube) {
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
  expect_same_cube(load(glb_file({{kJsonChunk, json},
                                  {kBinChunk, padded(cube().buffer, '\0')},
                                  {0x12345678, "whatever"},
                                  {0x12345678, ""}})));
}

TEST(GltfContainer, PercentEncodedDataUriGivesTheSameCube) {
  std::string encoded = "data:application/gltf-buffer,";
  for (const char byte : cube().buffer) {
    constexpr std::string_view kDigits = "0123456789aBcDeF";
    const auto value = static_cast<unsigned char>(byte);
    encoded += {'%', kDigits[value / 16], kDigits[value % 16]};
  }
  expect_same_cube(load(cube().with_buffer(encoded.c_str()).dump()));
}

TEST(GltfContainer, ErrorsInABinaryFileNameItsJsonChunk) {
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

TEST(GltfContainer, TrailingBytesAreIgnoredWithAWarning) {
  EXPECT_THAT(texts(load(cube().glb() + "xyz").warnings),
              testing::ElementsAre(": the GLB data is followed by 3 bytes without effect"));
}

TEST(GltfContainer, ZeroBytesAfterTheJsonGiveAWarning) {
  std::string json = cube().with_buffer(nullptr).dump();
  json.resize((json.size() + 7) / 4 * 4, '\0');
  const std::string bin = padded(cube().buffer, '\0');
  const LoadedScene loaded = load(glb_file({{kJsonChunk, json}, {kBinChunk, bin}}));
  EXPECT_EQ(loaded.scene.objects.size(), 1U);
  EXPECT_THAT(texts(loaded.warnings), testing::ElementsAre(HasSubstr("padded with zero bytes")));
}

TEST(GltfContainer, CaseHasNoMeaningInMediaTypes) {
  const std::string uri = "data:Application/Octet-Stream;base64," + base64(cube().buffer);
  expect_same_cube(load(cube().with_buffer(uri.c_str()).dump()));
}

TEST(GltfContainer, Base64MayBePercentEncoded) {
  std::string uri = "data:application/octet-stream;base64," + base64(cube().buffer);
  const auto last = static_cast<unsigned char>(uri.back());
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  uri.pop_back();
  uri += {'%', kDigits[last / 16], kDigits[last % 16]};
  expect_same_cube(load(cube().with_buffer(uri.c_str()).dump()));
}

TEST(GltfContainer, ByteOrderMarksGiveAWarning) {
  const std::string bin = padded(cube().buffer, '\0');
  const std::string json = padded("\xEF\xBB\xBF" + cube().with_buffer(nullptr).dump(), ' ');
  for (const std::string& bytes :
       {"\xEF\xBB\xBF" + cube().embedded(), glb_file({{kJsonChunk, json}, {kBinChunk, bin}})}) {
    const LoadedScene loaded = load(bytes);
    EXPECT_EQ(loaded.scene.objects.size(), 1U);
    EXPECT_THAT(texts(loaded.warnings), testing::ElementsAre(HasSubstr("byte order mark")));
  }
}

TEST(GltfContainer, BuffersWithoutTheirPaddingGiveAWarning) {
  const std::string json = padded(cube().with_buffer(nullptr).dump(), ' ');
  const auto loaded = [&](std::size_t missing) {
    // The last view has two bytes that no accessor uses.
    AssetBuilder asset = cube();
    asset.json["bufferViews"][1]["byteLength"] = asset.buffer.size() - 96 + missing;
    Json whole = asset.with_buffer(nullptr);
    whole["buffers"][0]["byteLength"] = asset.buffer.size() + missing;
    return load(glb_file({{kJsonChunk, padded(whole.dump(), ' ')}, {kBinChunk, asset.buffer}}));
  };
  EXPECT_THAT(texts(loaded(3).warnings), testing::ElementsAre(HasSubstr("the others are zero")));
  EXPECT_EQ(triangles_of(loaded(3).scene.objects.at(0)),
            triangles_of(load(cube()).scene.objects.at(0)));
  EXPECT_THROW((void)loaded(4), Error);
}

TEST(GltfContainer, UnalignedChunksGiveAWarning) {
  std::string json = cube().with_buffer(nullptr).dump();
  json.resize(json.size() / 4 * 4 + 5, ' ');
  const std::string bin = padded(cube().buffer, '\0');
  const LoadedScene loaded = load(glb_file({{kJsonChunk, json}, {kBinChunk, bin}}));
  EXPECT_EQ(loaded.scene.objects.size(), 1U);
  EXPECT_THAT(texts(loaded.warnings), testing::Contains(HasSubstr("not multiples of 4")));
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
  constexpr auto kInvalid = ErrorKind::invalid_scene;
  return {
      {"empty", "", kInvalid, "empty"},
      {"magic only", "glTF", kInvalid, "truncated"},
      {"header only", good.substr(0, 12), kInvalid, "truncated"},
      {"half", good.substr(0, good.size() / 2), kInvalid, "truncated"},
      {"last byte missing", good.substr(0, good.size() - 1), kInvalid, "truncated"},
      {"container version 1", glb_file({{kJsonChunk, json}}, 1), ErrorKind::unsupported, "version"},
      {"length beyond the file", wrong_length, kInvalid, "truncated"},
      {"length less than the header", no_length, kInvalid, "less than"},
      {"chunk longer than the file", long_chunk, kInvalid, "states"},
      {"BIN first", glb_file({{kBinChunk, bin}, {kJsonChunk, json}}), kInvalid, "first chunk"},
      {"BIN third", glb_file({{kJsonChunk, json}, {7, "1234"}, {kBinChunk, bin}}), kInvalid,
       "second"},
      {"two BIN", glb_file({{kJsonChunk, json}, {kBinChunk, bin}, {kBinChunk, bin}}), kInvalid,
       "second"},
      {"two JSON", glb_file({{kJsonChunk, json}, {kJsonChunk, json}}), kInvalid, "two JSON"},
      {"empty JSON", glb_file({{kJsonChunk, ""}, {kBinChunk, bin}}), kInvalid, "empty"},
      {"chunk header cut", glb_file({{kJsonChunk, json}}) + "1234", kInvalid, ""},
      {"not JSON", "{\"asset\":", kInvalid, ""},
      {"an array", "[1, 2, 3]", kInvalid, "object"},
  };
}

TEST(GltfContainer, BrokenFilesAreRefused) {
  for (const BadFile& file : bad_files()) {
    SCOPED_TRACE(file.name);
    std::string bytes = file.bytes;
    if (std::string_view(file.name) == "chunk header cut") {
      bytes[8] = static_cast<char>(bytes[8] + 4);  // lets the file's length include the stray bytes
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

// Tools copy names from older files.
TEST(GltfContainer, BytesThatAreNotUtf8AreReadAsLatin1) {
  AssetBuilder asset;
  asset.add_object(
      {{"attributes", {{"POSITION", asset.add_positions({Vec3(0), Vec3(1), Vec3(2)})}}}});
  asset.json["nodes"][0]["name"] = "Gr@@e \u65e5";
  std::string text = asset.embedded();
  const std::size_t at = text.find("@@");
  text[at] = '\xF6';
  text[at + 1] = '\xDF';
  const LoadedScene loaded = load(text);
  EXPECT_EQ(loaded.scene.objects.at(0).name.str(), "Gr\u00F6\u00DFe \u65E5/mesh0");
  EXPECT_THAT(texts(loaded.warnings), testing::ElementsAre(HasSubstr("read as Latin-1")));
  // Other faults are reported as for files in UTF-8.
  text[text.find("nodes") - 1] = ' ';
  EXPECT_THROW(static_cast<void>(load(text)), Error);
}

}  // namespace
}  // namespace microtrace::tests
