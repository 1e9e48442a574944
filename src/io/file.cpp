#include "io/file.hpp"

#include "base/memory_account.hpp"
#include "base/system/descriptor.hpp"
#include "base/system/error_text.hpp"
#include "io/confined_reads.hpp"

#include <microtrace/digest.hpp>
#include <microtrace/error.hpp>
#include <microtrace/read_files.hpp>

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <optional>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace microtrace::io {
namespace {

/// The hash of the innermost ReadDigest of this thread, or null.
thread_local Digest* digest_of_reads = nullptr;
/// The innermost ReadFiles of this thread, or null.
thread_local ReadFiles* files_read = nullptr;

std::optional<FileIdentity> identity_of(const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return std::nullopt;
  return FileIdentity{status.st_dev, status.st_ino};
}

FileState state_of(const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return {};
  return {.identity = {status.st_dev, status.st_ino},
          .size = status.st_size,
          .seconds = status.st_mtim.tv_sec,
          .nanoseconds = status.st_mtim.tv_nsec};
}

constexpr std::size_t kChunk = std::size_t{64} * 1024;

[[noreturn]] void fail(const std::string& name, std::string what, int code) {
  what.append(": ").append(error_text(code));
  throw Error(ErrorKind::io, name, std::move(what), code);
}

[[noreturn]] void fail_too_large(const std::string& name, std::size_t limit) {
  std::string message = "is larger than ";
  message.append(std::to_string(limit)).append(" bytes, the limit; split it");
  throw Error(ErrorKind::limit, name, message);
}

Descriptor open_file(const std::filesystem::path& path, int flags) {
  ConfinedReads::require(path, std::nullopt);
  // Before the file is opened, so that later changes are noticed. The file may be missing.
  note_unread_file(path);
  const int number = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | flags);
  if (number < 0) fail(path.string(), "can't be opened", errno);
  return Descriptor(number);
}

/// Reads until `bytes` has `wanted` bytes or the file ends. Returns true if the file ended.
bool fill(int descriptor, const std::string& name, std::string& bytes, std::size_t wanted) {
  std::size_t have = bytes.size();
  take_memory(wanted - have, "the bytes of " + name);
  bytes.resize(wanted);
  bool ended = false;
  while (have < wanted && !ended) {
    const ssize_t got = ::read(descriptor, bytes.data() + have, wanted - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(name, "can't be read", errno);
    have += static_cast<std::size_t>(got);
    ended = got == 0;
  }
  bytes.resize(have);
  return ended;
}

}  // namespace

std::string read_descriptor(int descriptor, const std::string& name, std::size_t limit,
                            const std::function<void(std::string_view)>& inspect) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail(name, "can't be read", errno);
  if (S_ISDIR(status.st_mode))
    throw Error(ErrorKind::io, name, "is a directory, not a file", EISDIR);
  if (files_read != nullptr) files_read->note(name, state_of(status));
  const std::size_t claimed =
      S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
  if (claimed > limit) fail_too_large(name, limit);

  // Requests one byte more, to detect a file that is longer than the limit or than its reported
  // size.
  std::string bytes;
  const std::size_t first = std::min(kChunk, limit + 1);
  bool ended = fill(descriptor, name, bytes, first);
  if (inspect) inspect(bytes);
  if (!ended && claimed > bytes.size()) ended = fill(descriptor, name, bytes, claimed + 1);
  while (!ended && bytes.size() <= limit) {
    ended = fill(descriptor, name, bytes, std::min(bytes.size() * 2, limit + 1));
  }
  if (bytes.size() > limit) fail_too_large(name, limit);
  // A scene can have very many small files.
  if (bytes.size() < first / 2) {
    bytes.shrink_to_fit();
    memory_account().give_back(first - bytes.size());
  }
  if (digest_of_reads != nullptr) digest_of_reads->add(bytes);
  return bytes;
}

std::string read_file(const std::filesystem::path& path, std::size_t limit,
                      const std::function<void(std::string_view)>& inspect) {
  const Descriptor descriptor = open_file(path, 0);
  ConfinedReads::require(path, descriptor.number());
  return read_descriptor(descriptor.number(), path.string(), limit, inspect);
}

void note_unread_file(const std::filesystem::path& path) {
  if (files_read != nullptr) files_read->note(path.string(), microtrace::state_of(path));
}

std::string read_regular_file(const std::filesystem::path& path, std::size_t limit,
                              const std::function<void(std::string_view)>& inspect) {
  const std::string name = path.string();
  // Without O_NONBLOCK, opening a pipe would block until the pipe has a writer.
  const Descriptor descriptor = open_file(path, O_NONBLOCK);
  ConfinedReads::require(path, descriptor.number());
  struct stat status {};
  if (::fstat(descriptor.number(), &status) != 0) fail(name, "can't be read", errno);
  if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
    throw Error(ErrorKind::io, name, "is not a regular file");
  return read_descriptor(descriptor.number(), name, limit, inspect);
}

std::optional<struct stat> status_of_target(const std::filesystem::path& path) {
  struct stat status {};
  const bool is_there =
      (path == "-" ? ::fstat(STDOUT_FILENO, &status) : ::stat(path.c_str(), &status)) == 0;
  return is_there ? std::optional(status) : std::nullopt;
}

void add_to_read_digest(std::string_view what) {
  if (digest_of_reads != nullptr) digest_of_reads->add(what);
}

}  // namespace microtrace::io

namespace microtrace {

ReadDigest::ReadDigest() : former_(io::digest_of_reads) {
  io::digest_of_reads = &digest_;
}

ReadDigest::~ReadDigest() {
  io::digest_of_reads = former_;
}

std::optional<FileIdentity> identity_of(const std::filesystem::path& path) {
  const auto status = io::status_of_target(path);
  return status ? io::identity_of(*status) : std::nullopt;
}

FileState state_of(const std::filesystem::path& path) {
  const auto status = io::status_of_target(path);
  return status ? io::state_of(*status) : FileState{};
}

ReadFiles::ReadFiles() : former_(io::files_read) {
  io::files_read = this;
}

ReadFiles::~ReadFiles() {
  io::files_read = former_;
}

std::optional<std::string> ReadFiles::name_of(const std::filesystem::path& path) const {
  const std::optional<FileIdentity> file = identity_of(path);
  const auto found = file ? name_of_.find(*file) : name_of_.end();
  return found != name_of_.end() ? std::optional(found->second) : std::nullopt;
}

}  // namespace microtrace
