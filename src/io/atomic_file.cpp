#include "io/atomic_file.hpp"

#include "base/system/descriptor.hpp"
#include "base/system/error_text.hpp"
#include "io/file.hpp"
#include "io/file_access.hpp"
#include "io/unfinished_files.hpp"

#include <microtrace/error.hpp>
#include <microtrace/read_files.hpp>

#include <cerrno>
#include <charconv>
#include <fcntl.h>
#include <optional>
#include <poll.h>
#include <random>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace microtrace::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_write(const fs::path& named, int error, std::string_view remedy) {
  std::string message = "can't be written: " + error_text(error) + "; ";
  message += remedy;
  throw Error(ErrorKind::io, named == "-" ? "standard output" : named.string(), message, error);
}

constexpr std::string_view kOpenForWriting = "open that descriptor for writing";

/// Returns the remedy if writing or closing a file fails with this error.
std::string_view remedy_of(int error) {
  switch (error) {
    case EPIPE:
      return "the program that reads the pipe has ended";
    case EBADF:
      return kOpenForWriting;
    case EFBIG:
      return "raise the limit on the size of files (ulimit -f), or name a file on another file "
             "system";
    default:
      return "free some space, or name another file";
  }
}

/// Returns the open descriptor that a path names: 1 for "-", N for /dev/fd/N and /proc/self/fd/N.
/// /dev/stdout is a link to the latter.
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

std::string random_name() {
  std::random_device device;
  std::string name = ".microtrace-";
  for (int i = 0; i < 16; ++i) name += "0123456789abcdef"[device() % 16];
  name += ".tmp";
  return name;
}

bool is_stream_resolved(const fs::path& target) {
  struct stat status {};
  return descriptor_number(target) || (::stat(target.c_str(), &status) == 0 &&
                                       !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode));
}

void require_writable(const fs::path& named, const fs::path& target) {
  if (::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
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

/// Checks that the target can be replaced. Returns the status of the existing file, if there is
/// one.
std::optional<struct stat> check_resolved(const fs::path& named, const fs::path& target) {
  if (!target.has_filename()) fail_to_write(named, EISDIR, "name a file");
  struct stat status {};
  std::optional<struct stat> existing;
  if (::stat(target.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail_to_write(named, EISDIR, "name a file in that folder");
    require_writable(named, target);
    if (!may_replace(folder_of(target), status))
      fail_to_write(named, EPERM, "another user owns the file, so name another file");
    existing = status;
  } else if (errno != ENOENT) {
    fail_to_write(named, errno, "name another file");
  }
  if (::faccessat(AT_FDCWD, folder_of(target).c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
    fail_to_write(named, errno,
                  errno == ENOENT ? "create its folder first"
                                  : "name a file in a folder that may be written to");
  }
  return existing;
}

}  // namespace

fs::path follow_links(fs::path path) {
  constexpr int kMaxLinks = 40;  // the limit of Linux
  std::error_code ignored;
  for (int links = 0; links < kMaxLinks; ++links) {
    if (descriptor_number(path) || !fs::is_symlink(path, ignored)) return path;
    path = path.parent_path() / fs::read_symlink(path, ignored);
  }
  return path;
}

AtomicFile::AtomicFile(const fs::path& target) : named_(target), target_(follow_links(target)) {
  if (const std::optional<int> number = descriptor_number(target_)) {
    descriptor_ = ::fcntl(*number, F_DUPFD_CLOEXEC, 0);
    if (descriptor_ < 0) fail(errno, kOpenForWriting);
  } else if (is_stream_resolved(target_)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno, "name a file");
  } else {
    open_temporary();
  }
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  forget_unfinished_file(slot_);
  slot_ = -1;
}

void AtomicFile::fail(int error, std::string_view remedy) {
  discard();
  fail_to_write(named_, error, remedy);
}

void AtomicFile::open_temporary() {
  const std::optional<struct stat> existing = check_resolved(named_, target_);
  do {
    forget_unfinished_file(slot_);
    temporary_ = folder_of(target_) / random_name();
    slot_ = note_unfinished_file(temporary_.c_str());
    descriptor_ =
        ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, existing ? 0600 : 0666);
  } while (descriptor_ < 0 && (errno == EEXIST || errno == EINTR));
  if (descriptor_ < 0) {
    const int error = errno;
    temporary_.clear();
    fail(error, error == ENOSPC || error == EDQUOT
                    ? "delete some files, because their number may be limited too, or name another "
                      "file"
                    : "name a file in a folder that may be written to");
  }
  if (existing) copy_access(target_, *existing, descriptor_);
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (written < 0 && errno == EAGAIN) {
      // Another program made the pipe non-blocking for all who share it.
      pollfd pipe{.fd = descriptor_, .events = POLLOUT, .revents = 0};
      static_cast<void>(::poll(&pipe, 1, -1));
    } else if (written == 0 || errno != EINTR) {
      const int error = written == 0 ? EIO : errno;
      fail(error, remedy_of(error));
    }
  }
}

void AtomicFile::close() {
  if (descriptor_ < 0) return;
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  // On Linux, a close() that returns EINTR has already closed the descriptor and handed over the
  // data.
  if (closed != 0 && errno != EINTR) fail(errno, remedy_of(errno));
}

void AtomicFile::sync() {
  // Streams can't be synchronized (EINVAL, EROFS).
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS && errno != EINTR)
    fail(errno, remedy_of(errno));
}

bool AtomicFile::commit_new() {
  close();
  if (temporary_.empty()) return true;
  if (::link(temporary_.c_str(), target_.c_str()) == 0) {
    discard();
    return true;
  }
  std::error_code error;
  const bool exists = errno == EEXIST || fs::exists(target_, error);
  if (exists)
    discard();
  else
    commit();
  return !exists;
}

bool AtomicFile::commit_over(const FileState& known) {
  // Another process that replaces the same file waits, and then finds another file there.
  const Descriptor locked(::open(target_.c_str(), O_RDWR | O_CLOEXEC));
  while (locked.number() >= 0 && ::flock(locked.number(), LOCK_EX) != 0 && errno == EINTR) {
  }
  const FileState now = state_of(target_);
  bool is_done = now == known;
  if (now == FileState{})
    is_done = commit_new();
  else if (is_done)
    commit();
  else
    discard();
  return is_done;
}

void AtomicFile::commit() {
  close();
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno, "name another file");
  temporary_.clear();
  discard();
}

void check_target(const fs::path& target) {
  const fs::path resolved = follow_links(target);
  if (is_stream_resolved(resolved))
    check_stream(target, resolved);
  else
    static_cast<void>(check_resolved(target, resolved));
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
