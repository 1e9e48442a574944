#pragma once
/// Runs the work of a query on threads that can be canceled.

#include <microtrace/error.hpp>
#include <microtrace/queries.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <new>

namespace microtrace {

/// Lets a thread report progress, and stops it when the query is canceled.
class Poll {
 public:
  /// report() throws if the thread must stop.
  explicit Poll(const std::function<void()>& report) : report_(report) {}

  /// Must be called after every few microseconds of work. Throws Error (canceled).
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

/// Calls f() and converts std::bad_alloc to Error (limit).
template <class F>
auto limiting_memory(const F& f) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, "", "no memory for the results of the query; ask for fewer");
  }
}

/// Calls f(first, last, poll) for consecutive runs [first, last) of the numbers from 0 to below
/// `count`, on several threads at the same time. Throws the first exception of f; Error (canceled).
void for_each_run(
    std::uint64_t count, std::uint64_t run, const QueryOptions& options,
    const std::function<void(std::uint64_t first, std::uint64_t last, Poll& poll)>& f);

}  // namespace microtrace
