#include "support/source_folder.hpp"

#include <microtrace/io.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path scenes = tests::source_folder() / "scenes";

class LoadScene : public ::testing::Test {
 protected:
  LoadScene() {
    std::string name = (std::filesystem::temp_directory_path() / "microtrace-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~LoadScene() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  static Error error_of(const std::filesystem::path& path) {
    try {
      (void)load_scene(path);
    } catch (const Error& error) {
      return error;
    }
    return {ErrorKind::internal, "", "no error"};
  }

  std::filesystem::path folder_;
};

TEST_F(LoadScene, ReadsEveryShippedScene) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scenes)) {
    if (entry.path().extension() != ".json") continue;
    const LoadedScene loaded = load_scene(entry.path());
    EXPECT_TRUE(loaded.warnings.empty()) << entry.path();
    EXPECT_FALSE(loaded.scene.objects.empty()) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 24U);
}

TEST_F(LoadScene, DetectsTheFormatByContentForOtherExtensions) {
  std::filesystem::copy_file(scenes / "sphere.json", folder_ / "a.scene");
  EXPECT_EQ(load_scene(folder_ / "a.scene").scene.cameras[0].name, "front");
  std::filesystem::copy_file(scenes / "gltf/cube.glb", folder_ / "b");
  EXPECT_FALSE(load_scene(folder_ / "b").scene.objects.empty());
  const Error error = error_of(write("c", R"({"asset": {"version": "1.0"}})"));
  EXPECT_THAT(error.what(), HasSubstr("1.0"));
}

TEST_F(LoadScene, AcceptsUpperCaseExtensions) {
  std::filesystem::copy_file(scenes / "gltf/cube.glb", folder_ / "B.GLB");
  EXPECT_FALSE(load_scene(folder_ / "B.GLB").scene.objects.empty());
  EXPECT_THAT(error_of(write("C.JSON", R"({"asset": {"version": "2.0"}})")).what(),
              HasSubstr("lacks the required member \"version\""));
}

TEST_F(LoadScene, RefusesGarbageFromItsFirstBytes) {
  // Sparse files of 900 MB: reading one completely would exceed the test's limits of memory and
  // time.
  for (const char* name : {"g.json", "g.gltf", "g.dat"}) {
    const std::filesystem::path path = write(name,
                                             "\x7F"
                                             "ELF");
    std::filesystem::resize_file(path, 900'000'000);
    EXPECT_EQ(error_of(path).kind(), ErrorKind::invalid_scene) << name;
    EXPECT_EQ(error_of(path).diagnostic().line, 1U) << name;
  }
}

TEST_F(LoadScene, PassesOnFileSystemErrors) {
  EXPECT_EQ(error_of(folder_ / "none.json").kind(), ErrorKind::io);
  EXPECT_EQ(error_of(folder_).kind(), ErrorKind::io);
  EXPECT_EQ(error_of(write("empty.json", "")).kind(), ErrorKind::invalid_scene);
}

}  // namespace
}  // namespace microtrace
