#include "io/output/atomic_file.hpp"

#include "base/system/descriptor.hpp"
#include "base/system/error_text.hpp"
#include "io/file.hpp"
#include "io/output/file_access.hpp"
#include "io/output/output_target.hpp"
#include "io/output/unfinished_files.hpp"

#include <microtrace/error.hpp>
#include <microtrace/read_files.hpp>

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <optional>
#include <poll.h>
#include <random>
#include <string>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace microtrace::io {
namespace {

namespace fs = std::filesystem;

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

/// The remedy if a mount point can't be overwritten.
constexpr std::string_view kNotMounted = "name a file that is not a mount point";

std::string random_name() {
  std::random_device device;
  std::string name = ".microtrace-";
  for (int i = 0; i < 16; ++i) name += "0123456789abcdef"[device() % 16];
  name += ".tmp";
  return name;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : named_(target), target_(follow_links(target)) {
  if (const std::optional<int> number = descriptor_number(target_)) {
    descriptor_ = ::fcntl(*number, F_DUPFD_CLOEXEC, 0);
    if (descriptor_ < 0) fail(errno, kOpenForWriting);
  } else if (is_stream(target_)) {
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
  is_mounted_ = false;
  forget_unfinished_file(slot_);
  slot_ = -1;
}

void AtomicFile::fail(int error, std::string_view remedy) {
  discard();
  fail_to_write(named_, error, remedy);
}

void AtomicFile::open_temporary() {
  const ReplacedFile replaced = check_file(named_, target_);
  is_mounted_ = replaced.is_mounted;
  if (is_mounted_) {
    descriptor_ = ::memfd_create("microtrace", MFD_CLOEXEC);
    if (descriptor_ < 0) fail(errno, kNotMounted);
    return;
  }
  const std::optional<struct stat>& existing = replaced.existing;
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
  if (descriptor_ < 0 || is_mounted_) return;
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
  if (is_mounted_) {
    discard();
    return false;
  }
  if (temporary_.empty()) return true;
  if (::link(temporary_.c_str(), target_.c_str()) == 0) {
    discard();
    return true;
  }
  if (errno != EEXIST &&
      ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0) {
    temporary_.clear();
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
  if (is_mounted_) return overwrite();
  close();
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno, "name another file");
  temporary_.clear();
  discard();
}

void AtomicFile::overwrite() {
  const Descriptor to(::open(target_.c_str(), O_WRONLY | O_CLOEXEC));
  const off_t size = ::lseek(descriptor_, 0, SEEK_END);
  if (to.number() < 0 || size < 0) fail(errno, kNotMounted);
  // Finds out whether there is enough space before the old content is lost, where this is possible.
  if (size > 0 && ::fallocate(to.number(), FALLOC_FL_KEEP_SIZE, 0, size) != 0 &&
      errno != EOPNOTSUPP && errno != ENOSYS && errno != EPERM && errno != EINTR)
    fail(errno, remedy_of(errno));
  for (off_t at = 0; at < size;) {
    const ssize_t copied =
        ::sendfile(to.number(), descriptor_, &at, static_cast<std::size_t>(size - at));
    if (copied == 0 || (copied < 0 && errno != EINTR)) {
      const int error = copied == 0 ? EIO : errno;
      fail(error, remedy_of(error));
    }
  }
  if (::ftruncate(to.number(), size) != 0) fail(errno, kNotMounted);
  discard();
}

}  // namespace microtrace::io
