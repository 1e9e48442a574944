#pragma once
/// The meaning of "threads = 0" in all options.
#include <microtrace/export.hpp>

namespace microtrace {

/// The number of processors available to this process, at least 1.
[[nodiscard]] MICROTRACE_EXPORT unsigned default_threads();

}  // namespace microtrace
