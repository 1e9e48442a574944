#include "dataset/links.hpp"

#include <microtrace/error.hpp>

#include <set>
#include <system_error>
#include <vector>

namespace microtrace {

void refuse_links(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::vector<fs::path> folders{folder};
  std::set<fs::path> followed;  // links may lead back
  while (!folders.empty()) {
    const fs::path next = folders.back();
    folders.pop_back();
    std::error_code error;
    for (fs::recursive_directory_iterator at(next, error), end; at != end; at.increment(error)) {
      if (!at->is_symlink(error)) continue;
      if (!at->is_directory(error)) {
        throw Error(ErrorKind::usage, at->path().string(),
                    "is a link to a file that the data set would overwrite; remove the link");
      }
      if (followed.insert(fs::canonical(at->path(), error)).second) folders.push_back(at->path());
    }
  }
}

}  // namespace microtrace
