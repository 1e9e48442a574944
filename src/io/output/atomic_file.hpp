#pragma once
/// Writes output files that appear completely or not at all.

#include <filesystem>
#include <string_view>

namespace microtrace {
struct FileState;
}

namespace microtrace::io {

/// An output file that is being written. It is a temporary file in the target's folder until
/// commit() renames it. The destructor removes an uncommitted file. If the target is a symbolic
/// link, the file that it leads to is replaced. The new file gets the access rights of the old one
/// (see copy_access). A file that is itself a mount point, as in containers, can't be replaced:
/// commit() overwrites its content, so it may be damaged if that is interrupted. Devices, pipes,
/// "-" and the names of open descriptors (/dev/stdout, /dev/fd/N) can't be replaced and are written
/// directly. All members except the destructor throw Error(io) with the path and the system's
/// reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);

  /// Closes the file and hands all data to the system. Nothing may be written afterwards.
  void close();

  /// Writes all data to the disk, so that a file that is committed afterwards is whole even after a
  /// power failure.
  void sync();

  /// Closes the file and renames it to the target.
  void commit();

  /// Does the same unless the target exists. Returns false if it does. If several processes commit
  /// the same new target, only one of them gets true, except on file systems without hard links and
  /// renameat2().
  [[nodiscard]] bool commit_new();

  /// Does the same if the target is a file in this state, or doesn't exist. Returns false if it was
  /// written or replaced since. Of several processes that replace a file of the same state, only
  /// one gets true, except on file systems without locks (flock) or hard links.
  [[nodiscard]] bool commit_over(const FileState& known);

 private:
  void open_temporary();
  void overwrite();
  void discard() noexcept;
  [[noreturn]] void fail(int error, std::string_view remedy);

  std::filesystem::path named_;      ///< path as given by the caller, for messages
  std::filesystem::path target_;     ///< path after following a final symbolic link
  std::filesystem::path temporary_;  ///< empty if the target is written directly, or after renaming
  bool is_mounted_ = false;  ///< the target is a mount point, and the descriptor a file in memory
  int descriptor_ = -1;
  int slot_ = -1;  ///< slot in the list of unfinished files; -1 if not listed
};

}  // namespace microtrace::io
