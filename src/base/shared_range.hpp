#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>

namespace microtrace {

/// The numbers from 0 to below `count`, which threads take in runs of consecutive ones. Any number
/// of threads may call take(), end() and is_ended().
class SharedRange {
 public:
  SharedRange(std::uint64_t count, std::uint64_t run) : count_(count), run_(run) {}

  /// Calls f(first, last) for runs [first, last) that no other call takes, until none is left or
  /// the range is ended. An exception of f ends the range, too.
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

  /// No more runs are taken.
  void end() { ended_ = true; }
  [[nodiscard]] bool is_ended() const { return ended_; }

  /// Throws the first exception of f, when all threads are done.
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
