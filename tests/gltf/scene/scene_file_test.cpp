#include "gltf/asset_builder.hpp"
#include "io/gltf/scene/scene.hpp"
#include "support/source_folder.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::IsEmpty;

LoadedScene load_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream bytes;
  bytes << file.rdbuf();
  return io::load_gltf(bytes.str(), path.filename().string(), path.parent_path());
}

std::filesystem::path scene(const char* name) {
  return source_folder() / "scenes" / "gltf" / name;
}

std::size_t triangle_count(const LoadedScene& loaded) {
  std::size_t count = 0;
  for (const Object& object : loaded.scene.objects) count += triangles_of(object).size();
  return count;
}

TEST(GltfSceneFile, LoadsExternalBuffers) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "microtrace_gltf_test";
  std::filesystem::create_directories(folder / "a b");
  // A file may be longer than the buffer's byteLength.
  std::ofstream(folder / "a b" / "cube.bin", std::ios::binary) << cube().buffer << "more";
  const std::string json = cube().with_buffer("a%20b/cube.bin").dump();
  const LoadedScene loaded = io::load_gltf(json, "cube.gltf", folder);
  EXPECT_EQ(triangles_of(loaded.scene.objects.at(0)),
            triangles_of(load(cube()).scene.objects.at(0)));
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());

  std::ofstream(folder / "a b" / "cube.bin", std::ios::binary) << "short";
  EXPECT_THROW((void)io::load_gltf(json, "cube.gltf", folder), Error);
  std::filesystem::remove_all(folder);
}

TEST(GltfSceneFile, CubeHasItsColorsOnTheRightSides) {
  const LoadedScene loaded = load_file(scene("cube.glb"));
  EXPECT_EQ(triangle_count(loaded), 12U);
  ASSERT_EQ(loaded.scene.objects.size(), 3U);
  EXPECT_NE(color_of(loaded, 0), color_of(loaded, 1));
  EXPECT_TRUE(loaded.scene.cameras.empty());
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
}

TEST(GltfSceneFile, KnotHasACamera) {
  const LoadedScene loaded = load_file(scene("knot.glb"));
  EXPECT_EQ(triangle_count(loaded), 1538U);
  EXPECT_EQ(loaded.scene.objects.size(), 5U);
  ASSERT_EQ(loaded.scene.cameras.size(), 1U);
  EXPECT_EQ(loaded.scene.cameras[0].name, "Front");
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());
}

}  // namespace
}  // namespace microtrace::tests
