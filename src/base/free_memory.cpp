#include "base/free_memory.hpp"

#include <microtrace/memory.hpp>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <unistd.h>

namespace microtrace {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// Returns the first word of a file if it is a number. A cgroup without a limit has the word "max".
std::optional<std::uint64_t> number_in(const fs::path& file) {
  std::uint64_t number = 0;
  if (!(std::ifstream(file) >> number)) return std::nullopt;
  return number;
}

/// Returns the number after `name` in a file whose lines are pairs of a name and a number.
std::optional<std::uint64_t> number_of(const std::string& name, const fs::path& file) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    std::uint64_t number = 0;
    if (words >> word >> number && word == name) return number;
  }
  return std::nullopt;
}

/// The names under which a version of cgroups stores these quantities.
struct GroupFiles {
  const char *limit, *usage;
  const char* cache;  ///< name in memory.stat of page cache that can be reclaimed at any time
};

std::uint64_t left_in_group(const fs::path& group, const GroupFiles& names) {
  const auto limit = number_in(group / names.limit);
  if (!limit) return kUnlimited;
  const std::uint64_t usage = number_in(group / names.usage).value_or(0);
  const std::uint64_t cache = number_of(names.cache, group / "memory.stat").value_or(0);
  const std::uint64_t in_use = usage - std::min(usage, cache);
  return *limit - std::min(*limit, in_use);
}

/// Returns the least memory left in the group and its ancestors. Includes the root of the mount,
/// which may be the group itself in a container.
std::uint64_t left_in_groups(const fs::path& mount, const fs::path& path, const GroupFiles& names) {
  std::uint64_t least = left_in_group(mount, names);
  fs::path group = mount;
  for (const fs::path& part : path.relative_path()) {
    group /= part;
    least = std::min(least, left_in_group(group, names));
  }
  return least;
}

std::uint64_t left_in_all_groups(const fs::path& root) {
  std::uint64_t least = kUnlimited;
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    // Lines are "number:controllers:path"; version 2 has number 0 and no controllers.
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const fs::path path = line.substr(second + 1);
    std::uint64_t left = kUnlimited;
    if (controllers == ",,") {
      left = left_in_groups(root / "sys/fs/cgroup", path,
                            {"memory.max", "memory.current", "inactive_file"});
    } else if (controllers.find(",memory,") != std::string::npos) {
      left =
          left_in_groups(root / "sys/fs/cgroup/memory", path,
                         {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"});
    }
    least = std::min(least, left);
  }
  return least;
}

}  // namespace

std::uint64_t free_memory(const fs::path& root) {
  std::uint64_t available = 0;
  if (const auto kib = number_of("MemAvailable:", root / "proc/meminfo")) {
    available = *kib * 1024;
  } else {
    available = static_cast<std::uint64_t>(std::max(::sysconf(_SC_PHYS_PAGES), 0L)) *
                static_cast<std::uint64_t>(std::max(::sysconf(_SC_PAGESIZE), 0L));
  }
  return std::min(available, left_in_all_groups(root));
}

std::uint64_t default_memory_limit() {
  return free_memory() / 4 * 3;
}

}  // namespace microtrace
