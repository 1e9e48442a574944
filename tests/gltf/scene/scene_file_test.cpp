#include "gltf/asset_builder.hpp"
#include "support/source_folder.hpp"

#include <microtrace/io.hpp>
#include <microtrace/memory.hpp>

#include <cstdint>
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
  return load_gltf(bytes.str(), path.filename().string(), path.parent_path());
}

std::filesystem::path scene(const char* name) {
  return source_folder() / "scenes" / "gltf" / name;
}

std::size_t triangle_count(const LoadedScene& loaded) {
  std::size_t count = 0;
  for (const Object& object : loaded.scene.objects) count += triangles_of(object).size();
  return count;
}

/// Returns how many bytes the budget still grants.
std::uint64_t rest_of(MemoryBudget& budget) {
  std::uint64_t rest = 0;
  for (std::uint64_t step = std::uint64_t{1} << 40U; step > 0; step /= 2) {
    try {
      budget.take(rest + step, "a test");
      budget.give_back(rest + step);
      rest += step;
    } catch (const Error&) {
      continue;
    }
  }
  return rest;
}

TEST(GltfSceneFile, LoadsExternalBuffers) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "microtrace_gltf_test";
  std::filesystem::create_directories(folder / "a b");
  // A file may be longer than the buffer's byteLength.
  std::ofstream(folder / "a b" / "cube.bin", std::ios::binary) << cube().buffer << "more";
  const std::string json = cube().with_buffer("a%20b/cube.bin").dump();
  const LoadedScene loaded = load_gltf(json, "cube.gltf", folder);
  EXPECT_EQ(triangles_of(loaded.scene.objects.at(0)),
            triangles_of(load(cube()).scene.objects.at(0)));
  EXPECT_THAT(texts(loaded.warnings), IsEmpty());

  std::ofstream(folder / "a b" / "cube.bin", std::ios::binary) << "short";
  EXPECT_THROW((void)load_gltf(json, "cube.gltf", folder), Error);
  std::filesystem::remove_all(folder);
}

TEST(GltfSceneFile, SmallBuffersTakeLittleMemory) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "microtrace_small_buffers";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "small.bin", std::ios::binary) << "small";
  std::ofstream(folder / "long.bin", std::ios::binary) << std::string(1U << 22U, 'x');
  std::string buffers;
  for (int i = 0; i < 1000; ++i)
    buffers += std::string(i == 0 ? "" : ",") + R"({"byteLength":5,"uri":"small.bin"})";
  for (int i = 0; i < 10; ++i) buffers += R"(,{"byteLength":5,"uri":"long.bin"})";
  const std::string json = R"({"asset":{"version":"2.0"},"buffers":[)" + buffers + "]}";
  MemoryBudget budget(std::uint64_t{1} << 23U);
  EXPECT_NO_THROW((void)load_gltf(json, "small.gltf", folder, DMat4(1), {.memory = &budget}));
  EXPECT_EQ(rest_of(budget), budget.limit());
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

TEST(GltfSceneFile, LastScenesReleaseTheMemoryOfTheFileButNotOfTheirImages) {
  MemoryBudget budget(std::uint64_t{1} << 30U);
  const std::filesystem::path path = scene("textured.glb");
  {
    SceneFile file(path, {.memory = &budget});
    EXPECT_GT(triangle_count(file.at(std::nullopt)), 0U);
    const std::uint64_t open = rest_of(budget);
    const LoadedScene loaded = file.last(std::nullopt);
    std::uint64_t images = 0;
    for (const auto& image : loaded.scene.images)
      images += std::uint64_t{image->width} * image->height * image->channels;
    ASSERT_GT(images, 0U);
    EXPECT_GE(rest_of(budget), open + std::filesystem::file_size(path));
    EXPECT_LE(rest_of(budget), budget.limit() - images);
    EXPECT_EQ(triangle_count(loaded), triangle_count(load_file(path)));
  }
  EXPECT_EQ(rest_of(budget), budget.limit());
}

}  // namespace
}  // namespace microtrace::tests
