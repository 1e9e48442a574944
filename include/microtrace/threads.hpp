#pragma once
/// The number of threads that "threads = 0" means in all options.
#include <microtrace/export.hpp>

namespace microtrace {

/// Returns the number of processors available to this process, at least 1: those on which it may
/// run, but no more than the CPU quota of its control groups (cgroups) grants, rounded up. The
/// quota is read once.
[[nodiscard]] MICROTRACE_EXPORT unsigned default_threads();

}  // namespace microtrace
