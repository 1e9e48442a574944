#include "cli/view/file_watch.hpp"

#include <utility>

namespace microtrace::cli {

void FileWatch::watch(const std::map<std::string, FileState>& files) {
  states_.insert(files.begin(), files.end());
}

bool FileWatch::has_changed() {
  bool differs = false;
  for (auto& [file, state] : states_) {
    const FileState now = state_of(file);
    if (now == state) continue;
    differs = true;
    state = now;
  }
  return std::exchange(is_changing_, differs) && !differs;
}

}  // namespace microtrace::cli
