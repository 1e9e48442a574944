#include "folder.hpp"
#include "io/image/codec_abi.hpp"
#include "io/module_function.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

using testing::HasSubstr;

/// Replaces the bytes of the codec module in a temporary folder that contains no other module.
class BrokenModule : public testing::Test {
 protected:
  void SetUp() override {
    whole_ = read_bytes(io::open_module(io::kCodecModuleFileName).path);
    ASSERT_GT(whole_.size(), 10000U);
    ::setenv("MICROTRACE_MODULE_PATH", (folder_ / "").c_str(), 1);
  }
  void TearDown() override { ::unsetenv("MICROTRACE_MODULE_PATH"); }

  /// Returns the error message of save_image if the module's file has these bytes.
  std::string complaint(const std::string& bytes) {
    write_bytes(folder_ / io::kCodecModuleFileName, bytes);
    try {
      save_image(Film({2, 2}), folder_ / "a.png");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::unsupported);
      return error.what();
    }
    return "nothing";
  }

  std::string whole_;
  Folder folder_;
};

TEST_F(BrokenModule, TruncationIsAnError) {
  for (std::size_t size = 0; size < whole_.size(); size += size < 4096 ? 64 : 1021) {
    EXPECT_THAT(complaint(whole_.substr(0, size)), HasSubstr("can't be used")) << size;
  }
  EXPECT_THAT(complaint(whole_.substr(0, whole_.size() - 1)), HasSubstr("truncated or damaged"));
}

TEST_F(BrokenModule, ZerosAtTheEndAreAnError) {
  std::string bytes = whole_;
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2), bytes.end(), '\0');
  EXPECT_THAT(complaint(bytes), HasSubstr("truncated or damaged"));
}

TEST_F(BrokenModule, OtherElfClassIsAnError) {
  EXPECT_THAT(complaint("not a library"), HasSubstr("not a shared library for this machine"));
  std::string bytes = whole_;
  bytes[4] = 1;  // ELFCLASS32
  EXPECT_THAT(complaint(bytes), HasSubstr("not a shared library for this machine"));
  std::filesystem::remove(folder_ / io::kCodecModuleFileName);
  std::filesystem::create_directory(folder_ / io::kCodecModuleFileName);
  try {
    save_image(Film({2, 2}), folder_ / "a.png");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("not a regular file"));
  }
}

TEST_F(BrokenModule, RestoredModuleIsUsed) {
  EXPECT_EQ(complaint(whole_), "nothing");
}

}  // namespace
}  // namespace microtrace
