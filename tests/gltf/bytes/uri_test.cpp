#include "io/gltf/bytes/uri.hpp"

#include "gltf/asset_builder.hpp"
#include "image/folder.hpp"

#include <microtrace/io.hpp>

#include <filesystem>
#include <fstream>
#include <utility>

#include <gmock/gmock.h>

namespace microtrace::io::gltf {
namespace {

using testing::HasSubstr;

// Test vectors from RFC 4648, section 10.
TEST(GltfUri, Base64TestVectors) {
  EXPECT_EQ(decode_base64(""), "");
  EXPECT_EQ(decode_base64("Zg=="), "f");
  EXPECT_EQ(decode_base64("Zm8="), "fo");
  EXPECT_EQ(decode_base64("Zm9v"), "foo");
  EXPECT_EQ(decode_base64("Zm9vYmFy"), "foobar");
  EXPECT_EQ(decode_base64("Zg"), "f");
  EXPECT_EQ(decode_base64("Zm8"), "fo");
}

TEST(GltfUri, Base64MayHaveWhiteSpace) {
  EXPECT_EQ(decode_base64(" Zm 9v\r\nYm\tFy\n"), "foobar");
  EXPECT_EQ(decode_base64("Zg\n=\f= "), "f");
  EXPECT_EQ(decode_base64(" \n"), "");
}

TEST(GltfUri, Base64RoundTrips) {
  std::string bytes;
  for (int i = 0; i < 600; ++i) {
    EXPECT_EQ(decode_base64(tests::base64(bytes)), bytes);
    bytes += static_cast<char>(i * 7 + i / 256);
  }
}

TEST(GltfUri, InvalidBase64IsRefused) {
  for (const char* text : {"Z", "Zg=", "Z===", "====", "Zm9v=", "Zm9vZ", "Zg==Zg==", "Zm9-",
                           "Zm\v9", "Z m9 v Z", "Zm 9v =", "=m9v"}) {
    EXPECT_FALSE(decode_base64(text)) << text;
  }
}

TEST(GltfUri, SplitsDataUris) {
  const auto uri = split_data_uri("data:application/gltf-buffer;a=b;base64,AAA=");
  ASSERT_TRUE(uri);
  EXPECT_EQ(uri->media_type, "application/gltf-buffer");
  EXPECT_TRUE(uri->is_base64);
  EXPECT_EQ(uri->data, "AAA=");
  EXPECT_FALSE(split_data_uri("data:,x")->is_base64);
  EXPECT_FALSE(split_data_uri("data:text/plain;base64"));
  EXPECT_FALSE(split_data_uri("data:text/plain;;base64,AAAA"));
  EXPECT_TRUE(is_data_uri("DATA:,"));
  EXPECT_FALSE(is_data_uri("data.bin"));
}

TEST(GltfUri, RelativePathsAreDecoded) {
  EXPECT_EQ(relative_path("a.bin").path, "a.bin");
  EXPECT_EQ(relative_path("sub/./a%20b%2Ebin").path, "sub/a b.bin");
  EXPECT_EQ(relative_path("./sub/../sub/x.png").path, "sub/x.png");
  EXPECT_EQ(relative_path("a/b/%2e%2E/../c").path, "c");
  EXPECT_EQ(relative_path("a/..").path, ".");
  EXPECT_EQ(relative_path("%C3%A4.bin").path, "\xC3\xA4.bin");
  EXPECT_EQ(relative_path("..a/b..").path, "..a/b..");
  EXPECT_EQ(relative_path("sub/a:b").path, "sub/a:b");
  for (const char* literal : {"a%", "a%4", "a%g0", "100% a%20b", "..%2f..%2fa%"}) {
    EXPECT_EQ(relative_path(literal).path, literal);
    EXPECT_TRUE(relative_path(literal).has_stray_percent);
  }
  EXPECT_FALSE(relative_path("a%20b").has_stray_percent);
}

TEST(GltfUri, PathsThatLeaveTheFolderAreRefused) {
  const std::pair<std::string, const char*> cases[] = {
      {"", "empty"},
      {"../a.bin", ".."},
      {"..", ".."},
      {"a/../../b", ".."},
      {"a/b/../../..", ".."},
      {"./..", ".."},
      {"a/%2e%2e/%2e%2e/b", ".."},
      {"%2e%2E/a.bin", ".."},
      {"a%2F..%2f..%2Fb", ".."},
      {"/etc/hostname", "absolute"},
      {"%2Fetc/hostname", "absolute"},
      {"//host/a.bin", "absolute"},
      {"file:///etc/hostname", "scheme"},
      {"http://example.org/a.bin", "scheme"},
      {"C:a.bin", "scheme"},
      {":", "scheme"},
      {"..\\a.bin", ".."},
      {"%2e.%5Ca.bin", ".."},
      {"\\a.bin", "absolute"},
      {"a%00.bin", "control"},
      {std::string("a\0b", 3), "control"},
      {"a\nb", "control"},
      {"C:\\a.bin", "Windows"},
      {"c:/a.bin", "Windows"},
  };
  for (const auto& [uri, reason] : cases) {
    EXPECT_THAT(relative_path(uri).refusal, HasSubstr(reason)) << uri;
    EXPECT_EQ(relative_path(uri).leads_out,
              std::string(reason) == ".." || std::string(reason) == "absolute")
        << uri;
  }
}

TEST(GltfUri, FilesMayBeInAllowedFolders) {
  const Folder folder;
  namespace fs = std::filesystem;
  for (const char* name : {"asset", "shared", "shared too"}) fs::create_directory(folder / name);
  tests::AssetBuilder asset;
  asset.add_object(
      {{"attributes", {{"POSITION", asset.add_positions({Vec3(0), Vec3(1), Vec3(2)})}}}});
  std::ofstream(folder / "shared/a.bin", std::ios::binary) << asset.buffer;
  const auto load_from = [&](const std::string& uri, std::vector<fs::path> allowed) {
    return parse_scene(asset.with_buffer(uri.c_str()).dump(), "test.gltf", folder / "asset",
                       {.allowed_folders = std::move(allowed)})
        .scene.objects.size();
  };
  EXPECT_EQ(load_from("../shared/a.bin", {folder / "shared"}), 1U);
  EXPECT_EQ(load_from("../asset/../shared/a.bin", {folder / "asset", folder / "shared"}), 1U);
  EXPECT_EQ(load_from((folder / "shared/a.bin").string(), {folder / "."}), 1U);
  EXPECT_EQ(load_from("..\\shared\\a.bin", {folder / "shared"}), 1U);
  for (const std::vector<fs::path>& allowed :
       {std::vector<fs::path>{}, {folder / "shared too"}, {folder / "asset"}, {folder / "none"}}) {
    try {
      (void)load_from("../shared/a.bin", allowed);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
      EXPECT_EQ(error.diagnostic().pointer, "/buffers/0/uri");
      EXPECT_THAT(error.what(), HasSubstr("--allow-path"));
    }
  }
}

}  // namespace
}  // namespace microtrace::io::gltf
