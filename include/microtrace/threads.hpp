#pragma once
/// What "threads = 0" means in every option.

namespace microtrace {

/// One for each processor that this process may use, at least 1.
[[nodiscard]] unsigned default_threads();

}  // namespace microtrace
