#pragma once
/// Starts threads. No other source of the library does.

#include <functional>
#include <thread>
#include <vector>

namespace microtrace {

/// Starts up to `count` threads that run `work`, which must not throw. Starts fewer threads if the
/// system refuses more because of limits on processes or memory. Callers must be able to finish the
/// shared work with any number of threads.
[[nodiscard]] std::vector<std::jthread> start_threads(unsigned count,
                                                      const std::function<void()>& work);

/// A function that runs work on threads of the host program; see RenderOptions::run_threads.
using HostThreads = std::function<void(unsigned threads, const std::function<void()>& work)>;

/// Runs work() on `count` threads at the same time, including the calling one, and waits for all.
/// Uses the host's threads if `host` isn't empty. Sets the FloatEnvironment of each thread. work()
/// must not throw. Returns the number of threads that the system refused to start.
unsigned run_on_threads(unsigned count, const HostThreads& host, const std::function<void()>& work);

/// Returns true if the system can start this many threads now.
[[nodiscard]] bool can_start_threads(unsigned count);

}  // namespace microtrace
