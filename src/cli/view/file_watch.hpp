#pragma once
/// Detects changes of files.

#include <cstdint>
#include <ctime>
#include <map>
#include <set>
#include <string>
#include <tuple>

namespace microtrace::cli {

/// Compares the state of files between calls. Unlike inotify, this also works for files on network
/// file systems and in folders that are mounted into containers.
class FileWatch {
 public:
  /// Watches these files from now on. Files that were watched before keep their state.
  void watch(const std::set<std::string>& files);

  /// Returns true once after each change of a watched file, when the file's state is the same in
  /// two consecutive calls, because a program may still be writing the file.
  [[nodiscard]] bool has_changed();

 private:
  /// Device, inode, size and time of the last change; zeros if there is no file.
  using State = std::tuple<std::uint64_t, std::uint64_t, std::int64_t, std::time_t, long>;

  [[nodiscard]] static State state_of(const std::string& file);

  std::map<std::string, State> states_;
  bool is_changing_ = false;
};

}  // namespace microtrace::cli
