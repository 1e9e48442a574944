#include "base/system/free_memory.hpp"

#include "base/system/control_groups.hpp"
#include "base/system/float_environment.hpp"

#include <microtrace/memory.hpp>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <sys/resource.h>
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

constexpr GroupFiles kFilesV1 = {"memory.limit_in_bytes", "memory.usage_in_bytes",
                                 "total_inactive_file"};
constexpr GroupFiles kFilesV2 = {"memory.max", "memory.current", "inactive_file"};

/// Returns the least memory left in any of the groups.
std::uint64_t left_in_all_groups(const fs::path& root) {
  std::uint64_t least = kUnlimited;
  for_each_control_group(root, "memory", [&](const fs::path& group, CgroupVersion version) {
    const GroupFiles& names = version == CgroupVersion::v2 ? kFilesV2 : kFilesV1;
    least = std::min(least, left_in_group(group, names));
  });
  return least;
}

/// Returns a limit of the process, such as RLIMIT_AS, in bytes.
std::optional<std::uint64_t> limit_of(decltype(RLIMIT_AS) resource) {
  rlimit limits{};
  const bool is_limited = ::getrlimit(resource, &limits) == 0 && limits.rlim_cur != RLIM_INFINITY;
  return is_limited ? std::optional<std::uint64_t>(limits.rlim_cur) : std::nullopt;
}

/// Returns the memory left within the limits of the process.
std::uint64_t left_in_process(const fs::path& root) {
  const auto space = limit_of(RLIMIT_AS), of_data = limit_of(RLIMIT_DATA);
  if (!space && !of_data) return kUnlimited;
  // The numbers of pages of the address space, and of data and stacks.
  std::uint64_t whole = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  std::ifstream(root / "proc/self/statm") >> whole >> resident >> shared >> text >> library >> data;
  const auto page = static_cast<std::uint64_t>(std::max(::sysconf(_SC_PAGESIZE), 0L));
  const auto left = [page](std::uint64_t limit, std::uint64_t pages) {
    return limit - std::min(limit, pages * page);
  };
  return std::min(space ? left(*space, whole) : kUnlimited,
                  of_data ? left(*of_data, data) : kUnlimited);
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
  return std::min({available, left_in_all_groups(root), left_in_process(root)});
}

bool has_limited_address_space() {
  return limit_of(RLIMIT_AS).has_value();
}

const char* out_of_memory() {
  if (has_limited_address_space()) return "out of memory; raise the limit of memory (ulimit -v)";
  if (limit_of(RLIMIT_DATA)) return "out of memory; raise the limit of data (ulimit -d)";
  return "out of memory";
}

std::uint64_t default_memory_limit() {
  const FloatEnvironment environment;
  return free_memory() / 4 * 3;
}

}  // namespace microtrace
