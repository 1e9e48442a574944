#include "io/output/output_target.hpp"

#include "base/system/error_text.hpp"
#include "io/file.hpp"
#include "io/output/file_access.hpp"

#include <microtrace/error.hpp>
#include <microtrace/read_files.hpp>

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <fcntl.h>
#include <string>
#include <unistd.h>
#include <utility>

namespace microtrace::io {
namespace {

namespace fs = std::filesystem;

bool is_stream_resolved(const fs::path& target) {
  struct stat status {};
  return descriptor_number(target) || (::stat(target.c_str(), &status) == 0 &&
                                       !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode));
}

// The checks use access(), which needs no recent system call: old container runtimes refuse
// faccessat2() with an error that says that the file is not accessible.
void require_writable(const fs::path& named, const fs::path& target) {
  if (::access(target.c_str(), W_OK) != 0)
    fail_to_write(named, errno, "allow writing to it, or name another file");
}

/// Checks that a stream can be written to.
void check_stream(const fs::path& named, const fs::path& target) {
  if (const std::optional<int> number = descriptor_number(target)) {
    const int flags = ::fcntl(*number, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) fail_to_write(named, EBADF, kOpenForWriting);
    return;
  }
  struct stat status {};
  if (::stat(target.c_str(), &status) == 0 && S_ISSOCK(status.st_mode))
    fail_to_write(named, ENXIO, "name a file");
  require_writable(named, target);
}

/// Returns the STATX_ATTR_ attributes of a file; 0 if the system doesn't know them.
std::uint64_t attributes_of(const fs::path& path) {
  struct statx status {};
  const bool is_known = ::statx(AT_FDCWD, path.c_str(), 0, 0, &status) == 0;
  return is_known ? status.stx_attributes & status.stx_attributes_mask : 0;
}

}  // namespace

[[noreturn]] void fail_to_write(const fs::path& named, int error, std::string_view remedy) {
  std::string message = "can't be written: " + error_text(error) + "; ";
  message += remedy;
  throw Error(ErrorKind::io, named == "-" ? "standard output" : named.string(), message, error);
}

std::optional<int> descriptor_number(const fs::path& path) {
  if (path == "-") return STDOUT_FILENO;
  const fs::path folder = path.parent_path();
  if (folder != "/dev/fd" && folder != "/proc/self/fd") return std::nullopt;
  const std::string name = path.filename().string();
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return number;
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path follow_links(fs::path path) {
  constexpr int kMaxLinks = 40;  // the limit of Linux
  std::error_code ignored;
  for (int links = 0; links < kMaxLinks; ++links) {
    if (descriptor_number(path) || !fs::is_symlink(path, ignored)) return path;
    path = path.parent_path() / fs::read_symlink(path, ignored);
  }
  return path;
}

ReplacedFile check_file(const fs::path& named, const fs::path& target) {
  if (!target.has_filename()) fail_to_write(named, EISDIR, "name a file");
  ReplacedFile file;
  struct stat status {};
  if (::stat(target.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail_to_write(named, EISDIR, "name a file in that folder");
    require_writable(named, target);
    const std::uint64_t attributes = attributes_of(target);
    if ((attributes & STATX_ATTR_APPEND) != 0)
      fail_to_write(named, EPERM, "the file may only be appended to, so name another file");
    file = {.existing = status, .is_mounted = (attributes & STATX_ATTR_MOUNT_ROOT) != 0};
    if (file.is_mounted) return file;
    if (!may_replace(folder_of(target), status))
      fail_to_write(named, EPERM, "another user owns the file, so name another file");
  } else if (errno != ENOENT) {
    fail_to_write(named, errno, "name another file");
  }
  if (::access(folder_of(target).c_str(), W_OK | X_OK) != 0) {
    fail_to_write(named, errno,
                  errno == ENOENT ? "create its folder first"
                                  : "name a file in a folder that may be written to");
  }
  return file;
}

void check_target(const fs::path& target) {
  const fs::path resolved = follow_links(target);
  if (is_stream_resolved(resolved))
    check_stream(target, resolved);
  else
    static_cast<void>(check_file(target, resolved));
}

bool is_stream(const fs::path& target) {
  return is_stream_resolved(follow_links(target));
}

}  // namespace microtrace::io

namespace microtrace {

namespace {

/// True for two names of one pipe or socket, such as "-" and /dev/stdout.
bool are_same_pipe(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto pipe_of = [](const std::filesystem::path& path) {
    const auto status = io::status_of_target(path);
    return status && (S_ISFIFO(status->st_mode) || S_ISSOCK(status->st_mode))
               ? std::optional(std::pair(status->st_dev, status->st_ino))
               : std::nullopt;
  };
  const auto pipe = pipe_of(a);
  return pipe && pipe == pipe_of(b);
}

}  // namespace

bool are_same_target(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (const auto file = identity_of(a)) return file == identity_of(b);
  if (are_same_pipe(a, b)) return true;
  const auto place = [](const std::filesystem::path& path) {
    std::error_code ignored;
    const std::filesystem::path target = io::follow_links(path);
    return std::filesystem::weakly_canonical(io::folder_of(target), ignored) / target.filename();
  };
  return (a == "-" || b == "-") ? a == b : place(a) == place(b);
}

}  // namespace microtrace
