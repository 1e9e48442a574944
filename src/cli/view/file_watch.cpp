#include "cli/view/file_watch.hpp"

#include <sys/stat.h>
#include <utility>

namespace microtrace::cli {

void FileWatch::watch(const std::set<std::string>& files) {
  std::map<std::string, State> states;
  for (const std::string& file : files) {
    const auto known = states_.find(file);
    states.emplace(file, known != states_.end() ? known->second : state_of(file));
  }
  states_ = std::move(states);
}

bool FileWatch::has_changed() {
  bool differs = false;
  for (auto& [file, state] : states_) {
    const State now = state_of(file);
    if (now == state) continue;
    differs = true;
    state = now;
  }
  return std::exchange(is_changing_, differs) && !differs;
}

FileWatch::State FileWatch::state_of(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec,
          status.st_mtim.tv_nsec};
}

}  // namespace microtrace::cli
