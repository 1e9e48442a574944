#include "base/system/control_groups.hpp"

#include <fstream>
#include <string>

namespace microtrace {

namespace fs = std::filesystem;

void for_each_control_group(const fs::path& root, std::string_view controller,
                            const std::function<void(const fs::path&, CgroupVersion)>& visit) {
  const std::string listed = "," + std::string(controller) + ",";
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    // Lines are "number:controllers:path"; version 2 has number 0 and no controllers.
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool is_v2 = controllers == ",,";
    if (!is_v2 && controllers.find(listed) == std::string::npos) continue;
    const CgroupVersion version = is_v2 ? CgroupVersion::v2 : CgroupVersion::v1;
    fs::path group = root / "sys/fs/cgroup";
    if (!is_v2) group /= controller;
    visit(group, version);
    const fs::path path = line.substr(second + 1);
    for (const fs::path& part : path.relative_path()) {
      group /= part;
      visit(group, version);
    }
  }
}

}  // namespace microtrace
