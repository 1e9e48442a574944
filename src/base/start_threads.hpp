#pragma once
/// The one place where threads are started.

#include <functional>
#include <thread>
#include <vector>

namespace microtrace {

/// Starts up to `count` threads that run `work`, which must not throw. Fewer where the system
/// refuses more (limits on processes or memory): callers finish shared work with the threads there
/// are.
[[nodiscard]] std::vector<std::jthread> start_threads(unsigned count,
                                                      const std::function<void()>& work);

/// Whether the system would start so many threads now.
[[nodiscard]] bool can_start_threads(unsigned count);

}  // namespace microtrace
