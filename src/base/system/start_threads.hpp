#pragma once
/// Starts threads. No other source of the library does.

#include <cstddef>
#include <functional>
#include <optional>
#include <pthread.h>
#include <vector>

namespace microtrace {

/// The size in bytes of a stack on which rays can be traced. The kernels for streams of rays use
/// almost half of it.
inline constexpr std::size_t kStackSize = std::size_t{1} << 20U;

/// Returns the number of bytes that are free on the calling thread's stack, 0 if it is unknown.
[[nodiscard]] std::size_t free_stack();

/// A thread that is joined when it is destroyed. Its stack has at least kStackSize bytes, unlike
/// that of a std::jthread if the system's default is smaller.
class Thread {
 public:
  /// Runs `work`, which must not throw. Throws std::system_error if the system refuses.
  explicit Thread(std::function<void()> work);
  Thread(Thread&& other) noexcept;
  ~Thread();
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;
  Thread& operator=(Thread&&) = delete;

  /// Lets the thread run on after this object is destroyed.
  void detach();

 private:
  std::optional<pthread_t> thread_;
};

/// Starts up to `count` threads that run `work`, which must not throw. Starts fewer threads if the
/// system refuses more because of limits on processes or memory. Callers must be able to finish the
/// shared work with any number of threads.
[[nodiscard]] std::vector<Thread> start_threads(unsigned count, const std::function<void()>& work);

/// A function that runs work on threads of the host program; see RenderOptions::run_threads.
using HostThreads = std::function<void(unsigned threads, const std::function<void()>& work)>;

/// Runs work() on `count` threads at the same time, including the calling one, and waits for all.
/// Uses the host's threads if `host` isn't empty. Sets the FloatEnvironment of each thread. work()
/// must not throw. Returns the number of threads that the system refused to start. Throws Error
/// (usage) if the host never calls work().
unsigned run_on_threads(unsigned count, const HostThreads& host, const std::function<void()>& work);

/// Returns true if the system can start this many threads now.
[[nodiscard]] bool can_start_threads(unsigned count);

}  // namespace microtrace
