#pragma once
/// How many processors this process may use.

#include <filesystem>
#include <optional>

namespace microtrace {

/// Returns the number of processors on which this process may run, for which libraries start
/// threads whatever the quota is.
[[nodiscard]] unsigned allowed_processors();

/// Returns the processor time per time that the groups grant, rounded up: 2 for `docker run
/// --cpus 1.5`. Returns nothing if no group has such a limit. `root` is the folder that contains
/// proc and sys. More threads than this would be stopped for a part of each period.
[[nodiscard]] std::optional<unsigned> processor_quota(const std::filesystem::path& root = "/");

/// Returns the number of threads that an option states: default_threads() if it is 0.
[[nodiscard]] unsigned thread_count(unsigned option);

}  // namespace microtrace
