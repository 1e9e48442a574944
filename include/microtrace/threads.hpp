#pragma once
/// What "threads = 0" means in every option.
#include <microtrace/export.hpp>

namespace microtrace {

/// One for each processor that this process may use, at least 1.
[[nodiscard]] MICROTRACE_EXPORT unsigned default_threads();

}  // namespace microtrace
