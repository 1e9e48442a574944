#pragma once
/// How many processors the control groups (cgroups) of this process grant it.

#include <filesystem>
#include <optional>

namespace microtrace {

/// Returns the processor time per time that the groups grant, rounded up: 2 for `docker run
/// --cpus 1.5`. Returns nothing if no group has such a limit. `root` is the folder that contains
/// proc and sys. More threads than this would be stopped for a part of each period.
[[nodiscard]] std::optional<unsigned> processor_quota(const std::filesystem::path& root = "/");

}  // namespace microtrace
