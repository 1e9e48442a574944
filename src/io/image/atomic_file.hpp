#pragma once
/// Output files that appear whole or not at all.

#include <filesystem>
#include <string_view>

namespace microtrace::io {

/// A file being written. It is a temporary in the target's folder until commit() renames it; the
/// destructor removes what was not committed. A target behind a symbolic link is replaced where it
/// lies, and keeps its permissions. Devices, pipes, "-" and the names of open descriptors
/// (/dev/stdout, /dev/fd/N) can't be replaced: they are written straight.
/// Every member but the destructor throws Error(io) with the path and the system's reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);

  /// Closes the file: all of it is with the system then. Nothing may be written after it.
  void close();

  /// Closes the file and puts it in the target's place.
  void commit();

 private:
  void open_temporary();
  void discard() noexcept;
  [[noreturn]] void fail(int error, std::string_view remedy);

  std::filesystem::path named_;      ///< as the caller named it, for messages
  std::filesystem::path target_;     ///< with a final symbolic link resolved
  std::filesystem::path temporary_;  ///< empty if written straight, or once renamed
  int descriptor_ = -1;
  int slot_ = -1;  ///< in the list of unfinished files, -1 if not there
};

/// Throws Error(io) if an AtomicFile for this target would fail at once, and touches nothing.
void check_target(const std::filesystem::path& target);

/// Is the target written straight, because it is there and no regular file, or an open descriptor?
[[nodiscard]] bool is_stream(const std::filesystem::path& target);

}  // namespace microtrace::io
