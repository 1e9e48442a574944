#include "io/output/atomic_file.hpp"

#include "folder.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <csignal>
#include <fcntl.h>
#include <future>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Returns the message of the Error(io) that save_image throws.
std::string failure(const fs::path& path, const Film& film = gradient()) {
  try {
    save_image(film, path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    EXPECT_EQ(error.diagnostic().file, path.string());
    return error.what();
  }
  return "saved";
}

/// Limits the size of files to `bytes`. A longer write then fails in the middle.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST(AtomicFile, FailuresNameTheFileTheReasonAndTheRemedy) {
  const Folder folder;
  write_bytes(folder / "file", "x");
  fs::create_directory(folder / "d.ppm");
  EXPECT_THAT(failure(folder / "missing/a.ppm"),
              HasSubstr("a.ppm: can't be written: No such file"));
  EXPECT_THAT(failure(folder / "missing/a.ppm"), HasSubstr("create its folder first"));
  EXPECT_THAT(failure(folder / "file/a.ppm"), HasSubstr("Not a directory"));
  EXPECT_THAT(failure(folder / "d.ppm"), HasSubstr("Is a directory"));
  EXPECT_THAT(failure("/dev/full"), HasSubstr("No space left on device"));
  EXPECT_EQ(folder.entries(), 2U);
}

TEST(AtomicFile, FailuresAreReportedInAdvance) {
  const Folder folder;
  fs::create_directory(folder / "d.ppm");
  EXPECT_THROW(check_image_path(folder / "missing/a.ppm"), Error);
  EXPECT_THROW(check_image_path(folder / "d.ppm"), Error);
  EXPECT_THROW(check_image_path(folder / "a"), Error);
  EXPECT_THROW(check_image_path(folder / "."), Error);
  EXPECT_NO_THROW(check_image_path(folder / "a.ppm"));
  EXPECT_NO_THROW(check_image_path("-"));
  EXPECT_NO_THROW(check_image_path("/dev/stdout"));
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFile, ShortWriteKeepsTheOldFileAndLeavesNothing) {
  const Folder folder;
  write_bytes(folder / "old.ppm", "old");
  {
    const FileSizeLimit limit(100000);
    for (const char* name : {"old.ppm", "new.ppm"}) {
      EXPECT_THAT(failure(folder / name, gradient({300, 200})),
                  HasSubstr("File too large; raise the limit on the size of files (ulimit -f)"));
    }
  }
  EXPECT_EQ(read_bytes(folder / "old.ppm"), "old");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFile, FileAppearsOnCommit) {
  const Folder folder;
  write_bytes(folder / "a", "old");
  {
    io::AtomicFile file(folder / "a");
    file.write("new");
    EXPECT_EQ(read_bytes(folder / "a"), "old");
    EXPECT_EQ(folder.entries(), 2U);
    file.commit();
  }
  EXPECT_EQ(read_bytes(folder / "a"), "new");
  { io::AtomicFile(folder / "a").write("dropped"); }
  EXPECT_EQ(read_bytes(folder / "a"), "new");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFile, SignalHandlerRemovesUnfinishedFiles) {
  const Folder folder;
  io::AtomicFile file(folder / "a");
  file.write("half");
  ASSERT_EQ(folder.entries(), 1U);
  remove_unfinished_files();
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(AtomicFile, SignalHandlerLeavesFinishedFiles) {
  const Folder folder;
  for (int i = 0; i < 20; ++i) save_image(gradient(), folder / "a.ppm");
  remove_unfinished_files();
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFile, PermissionsFollowTheUmaskAndThenTheOldFile) {
  const Folder folder;
  const mode_t before = ::umask(027);
  save_image(gradient(), folder / "a.ppm");
  ::umask(before);
  EXPECT_EQ(fs::status(folder / "a.ppm").permissions(), static_cast<fs::perms>(0640));
  fs::permissions(folder / "a.ppm", static_cast<fs::perms>(0604));
  save_image(gradient(), folder / "a.ppm");
  EXPECT_EQ(fs::status(folder / "a.ppm").permissions(), static_cast<fs::perms>(0604));
}

TEST(AtomicFile, LinksStayAndTheirTargetIsReplaced) {
  const Folder folder;
  fs::create_directory(folder / "far");
  fs::create_symlink("far/a.ppm", folder / "link.ppm");
  for (int i = 0; i < 2; ++i) {  // the link dangles in the first round only
    save_image(gradient(), folder / "link.ppm");
    EXPECT_TRUE(fs::is_symlink(folder / "link.ppm"));
    EXPECT_EQ(read_bytes(folder / "far/a.ppm"), encode_ppm(gradient()));
  }
}

TEST(AtomicFile, LoopOfLinksFails) {
  const Folder folder;
  fs::create_symlink("b.ppm", folder / "a.ppm");
  fs::create_symlink("a.ppm", folder / "b.ppm");
  EXPECT_THAT(failure(folder / "a.ppm"), HasSubstr("Too many levels of symbolic links"));
}

TEST(AtomicFile, PipesAreWrittenDirectly) {
  const Folder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto read = std::async(std::launch::async, [&pipe] { return read_bytes(pipe); });
  save_image(gradient(), pipe);
  EXPECT_EQ(read.get(), encode_ppm(gradient()));
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(AtomicFile, StandardOutputIsWrittenDirectly) {
  const Folder folder;
  for (const char* name : {"-", "/dev/stdout", "/dev/fd/1"}) {
    const int saved = ::dup(STDOUT_FILENO);
    const int file = ::open((folder / "out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(file, STDOUT_FILENO);
    EXPECT_EQ(::write(STDOUT_FILENO, "before ", 7), 7);
    EXPECT_NO_THROW(save_image(gradient(), name));
    ::dup2(saved, STDOUT_FILENO);
    ::close(file);
    ::close(saved);
    EXPECT_EQ(read_bytes(folder / "out"), "before " + encode_ppm(gradient())) << name;
  }
}

}  // namespace
}  // namespace microtrace
