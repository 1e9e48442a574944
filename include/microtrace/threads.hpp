#pragma once
/// The number of threads that "threads = 0" means in all options.
#include <microtrace/export.hpp>

namespace microtrace {

/// Returns the number of processors available to this process, at least 1.
[[nodiscard]] MICROTRACE_EXPORT unsigned default_threads();

}  // namespace microtrace
