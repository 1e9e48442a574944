#pragma once
/// Detects changes of files.

#include <microtrace/read_files.hpp>

#include <map>
#include <string>

namespace microtrace::cli {

/// Compares the state of files between calls. Unlike inotify, this also works for files on network
/// file systems and in folders that are mounted into containers.
class FileWatch {
 public:
  /// Watches these files for changes from the given states. Files that were watched before keep
  /// their state.
  void watch(const std::map<std::string, FileState>& files);

  /// Returns true once after each change of a watched file, when the file's state is the same in
  /// two consecutive calls, because a program may still be writing the file.
  [[nodiscard]] bool has_changed();

 private:
  std::map<std::string, FileState> states_;
  bool is_changing_ = false;
};

}  // namespace microtrace::cli
