#pragma once
/// Output files that appear whole or not at all.

#include <filesystem>
#include <string_view>

namespace microtrace::io {

/// An output file that is being written: a temporary file in the target's folder until commit()
/// renames it; the destructor removes an uncommitted file. A target behind a symbolic link is
/// replaced at the link's target, and keeps its permissions. Devices, pipes, "-" and the names of
/// open descriptors (/dev/stdout, /dev/fd/N) can't be replaced and are written directly. All
/// members except the destructor throw Error(io) with the path and the system's reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);

  /// Closes the file and hands all data to the system. Nothing may be written afterwards.
  void close();

  /// Closes the file and renames it to the target.
  void commit();

 private:
  void open_temporary();
  void discard() noexcept;
  [[noreturn]] void fail(int error, std::string_view remedy);

  std::filesystem::path named_;      ///< as the caller named it, for messages
  std::filesystem::path target_;     ///< with a final symbolic link resolved
  std::filesystem::path temporary_;  ///< empty if written directly, or after renaming
  int descriptor_ = -1;
  int slot_ = -1;  ///< in the list of unfinished files; -1 if not listed
};

/// Throws Error(io) if an AtomicFile for this target would fail immediately. Has no side effects.
void check_target(const std::filesystem::path& target);

/// True if the target is written directly, because it is an open descriptor or an existing file
/// that is not regular.
[[nodiscard]] bool is_stream(const std::filesystem::path& target);

}  // namespace microtrace::io
