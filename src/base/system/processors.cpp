#include "base/system/processors.hpp"

#include "base/system/control_groups.hpp"

#include <microtrace/threads.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sched.h>
#include <thread>

namespace microtrace {
namespace {

namespace fs = std::filesystem;

/// Returns the processors that one group grants. A group without a limit has the quota "max" or -1.
std::optional<double> quota_of(const fs::path& group, CgroupVersion version) {
  double quota = 0, period = 0;
  if (version == CgroupVersion::v2) {
    if (!(std::ifstream(group / "cpu.max") >> quota >> period)) return std::nullopt;
  } else if (!(std::ifstream(group / "cpu.cfs_quota_us") >> quota) ||
             !(std::ifstream(group / "cpu.cfs_period_us") >> period)) {
    return std::nullopt;
  }
  if (!(quota > 0 && period > 0)) return std::nullopt;
  return quota / period;
}

}  // namespace

unsigned allowed_processors() {
  // hardware_concurrency() also counts processors that a container or taskset excludes.
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0)
    return static_cast<unsigned>(std::max(1, CPU_COUNT(&allowed)));
  return std::max(1U, std::thread::hardware_concurrency());
}

std::optional<unsigned> processor_quota(const fs::path& root) {
  std::optional<unsigned> least;
  for_each_control_group(root, "cpu", [&](const fs::path& group, CgroupVersion version) {
    constexpr double kMost = 1 << 20;
    const auto quota = quota_of(group, version);
    if (!quota) return;
    const auto whole = static_cast<unsigned>(std::ceil(std::min(*quota, kMost)));
    least = std::min(least.value_or(whole), whole);
  });
  return least;
}

unsigned default_threads() {
  // Queries of a few rays ask too, and reading the files takes longer than such a query.
  static const std::optional<unsigned> quota = processor_quota();
  const unsigned allowed = allowed_processors();
  return quota ? std::min(*quota, allowed) : allowed;
}

unsigned thread_count(unsigned option) {
  return option != 0 ? option : default_threads();
}

}  // namespace microtrace
