// Checks that every file in bad/ is rejected with exactly the message beside it, and that every
// file in good/ is read.

#include "io/file.hpp"
#include "support/source_folder.hpp"

#include <microtrace/io.hpp>

#include <filesystem>
#include <set>
#include <string>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

const std::filesystem::path folder = tests::source_folder() / "tests/io";

std::set<std::filesystem::path> files(const char* name, const char* ending) {
  std::set<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder / name)) {
    if (entry.path().extension() == ending) out.insert(entry.path());
  }
  return out;
}

/// Returns the loader's error message without the folder's name.
std::string complaint(const std::filesystem::path& path) {
  try {
    (void)load_scene(path);
  } catch (const Error& error) {
    std::string text = error.what();
    const std::string prefix = path.parent_path().string() + "/";
    for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return "exit code " + std::to_string(static_cast<int>(error.kind())) + "\n" + text + "\n";
  }
  return "accepted\n";
}

TEST(Corpus, RefusesEachBadFileWithItsMessage) {
  const auto paths = files("bad", ".json");
  EXPECT_GE(paths.size(), 100U);
  for (std::filesystem::path path : paths) {
    const std::string said = complaint(path);
    path.replace_extension(".txt");
    ASSERT_TRUE(std::filesystem::exists(path)) << path << " should hold:\n" << said;
    EXPECT_EQ(said, io::read_file(path, 10'000)) << path;
  }
  EXPECT_EQ(files("bad", ".txt").size(), paths.size());
}

TEST(Corpus, ReadsEachGoodFile) {
  const auto paths = files("good", ".json");
  EXPECT_GE(paths.size(), 20U);
  for (const std::filesystem::path& path : paths) EXPECT_EQ(complaint(path), "accepted\n") << path;
}

}  // namespace
}  // namespace microtrace
