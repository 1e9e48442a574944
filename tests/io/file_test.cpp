#include "io/file.hpp"

#include <microtrace/error.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sys/stat.h>
#include <thread>

#include <gmock/gmock.h>

namespace microtrace::io {
namespace {

using ::testing::HasSubstr;

class File : public ::testing::Test {
 protected:
  File() {
    std::string name = (std::filesystem::temp_directory_path() / "microtrace-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~File() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& bytes) {
    std::ofstream(folder_ / "file", std::ios::binary) << bytes;
    return folder_ / "file";
  }

  static Error error_of(const std::filesystem::path& path, std::size_t limit) {
    try {
      const std::string bytes = read_file(path, limit);
    } catch (const Error& error) {
      return error;
    }
    return {ErrorKind::internal, "", "no error"};
  }

  std::filesystem::path folder_;
};

TEST_F(File, ReadsEveryByte) {
  for (const std::size_t size : {0U, 1U, 65535U, 65536U, 65537U, 1000000U}) {
    std::string bytes(size, 'x');
    if (size > 1) bytes[size / 2] = '\0';
    EXPECT_EQ(read_file(write(bytes), 1000000), bytes);
  }
}

TEST_F(File, NamesTheReason) {
  EXPECT_EQ(error_of(folder_ / "none", 10).kind(), ErrorKind::io);
  EXPECT_THAT(error_of(folder_ / "none", 10).what(), HasSubstr("No such file or directory"));
  EXPECT_EQ(error_of(folder_, 10).kind(), ErrorKind::io);
  EXPECT_THAT(error_of(folder_, 10).what(), HasSubstr("is a directory"));
  EXPECT_EQ(error_of(write("12345678901"), 10).kind(), ErrorKind::limit);
  EXPECT_EQ(read_file(write("1234567890"), 10).size(), 10U);
}

TEST_F(File, RefusesAHugeFileUnread) {
  const std::filesystem::path path = write("{");
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40U);
  EXPECT_EQ(error_of(path, kMaxFileSize).kind(), ErrorKind::limit);
  EXPECT_EQ(error_of("/dev/zero", 1'000'000).kind(), ErrorKind::limit);
}

TEST_F(File, ReadsAPipe) {
  const std::filesystem::path path = folder_ / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const std::string bytes(300'000, 'p');
  std::thread writer([&] { std::ofstream(path) << bytes; });
  EXPECT_EQ(read_file(path, 1'000'000), bytes);
  writer.join();
}

TEST_F(File, ReferencedFilesMustBeRegular) {
  EXPECT_EQ(read_regular_file(write("12345"), 10), "12345");
  const std::filesystem::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::filesystem::path& path : {pipe, std::filesystem::path("/dev/zero"), folder_}) {
    try {
      (void)read_regular_file(path, 10);
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io) << path;
    }
  }
}

TEST_F(File, LetsTheCallerRejectByTheFirstBytes) {
  const std::filesystem::path path = write(std::string(1'000'000, 'x'));
  std::size_t seen = 0;
  const auto refuse = [&](std::string_view first) {
    seen = first.size();
    throw Error(ErrorKind::invalid_scene, "f", "no");
  };
  EXPECT_THROW((void)read_file(path, 2'000'000, refuse), Error);
  EXPECT_EQ(seen, 65536U);
}

}  // namespace
}  // namespace microtrace::io
