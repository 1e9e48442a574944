#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>

namespace microtrace {

/// The numbers from 0 to count - 1, which several threads process in runs of consecutive numbers.
/// Any number of threads may call take(), end() and is_ended().
class SharedRange {
 public:
  SharedRange(std::uint64_t count, std::uint64_t run) : count_(count), run_(run) {}

  /// Calls f(first, last) for runs [first, last) that no other thread has taken, until none is left
  /// or the range is ended. An exception thrown by f ends the range.
  template <typename F>
  void take(const F& f) {
    try {
      for (std::uint64_t first; !is_ended() && (first = next_.fetch_add(run_)) < count_;)
        f(first, std::min(first + run_, count_));
    } catch (...) {
      end();
      const std::scoped_lock lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
  }

  /// Ends the range, so that no more runs are taken.
  void end() { ended_ = true; }
  [[nodiscard]] bool is_ended() const { return ended_; }

  /// Rethrows the first exception thrown by f, if there was one. Must be called after all threads
  /// have returned from take().
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::uint64_t count_, run_;
  std::atomic<std::uint64_t> next_{0};
  std::atomic<bool> ended_ = false;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace microtrace
