#pragma once
/// Runs a query on several threads, which report progress and can be canceled.

#include <microtrace/error.hpp>
#include <microtrace/queries.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <new>

namespace microtrace {

/// Lets a thread report progress, and stops the thread when the query is canceled.
class Poll {
 public:
  /// report() must throw if the thread must stop.
  explicit Poll(const std::function<void()>& report) : report_(report) {}

  /// Must be called after every few microseconds of work. Throws Error (canceled) if the query is
  /// canceled.
  void operator()() {
    if (++calls_ % kCallsPerLook == 0) look();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr unsigned kCallsPerLook = 16;

  void look();

  const std::function<void()>& report_;
  unsigned calls_ = 0;
  Clock::time_point last_ = Clock::now();
};

/// Returns the result of f(), and converts std::bad_alloc to Error (limit).
template <class F>
auto limiting_memory(const F& f) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, "", "no memory for the results of the query; ask for fewer");
  }
}

/// Calls f(first, last, poll) for runs [first, last) of `run` numbers that together cover 0 to
/// count - 1, on several threads at the same time. Rethrows the first exception thrown by f. Throws
/// Error (canceled) if options.progress returns false.
void for_each_run(
    std::uint64_t count, std::uint64_t run, const QueryOptions& options,
    const std::function<void(std::uint64_t first, std::uint64_t last, Poll& poll)>& f);

}  // namespace microtrace
