#include "queries/runs.hpp"

#include "base/shared_range.hpp"
#include "base/system/processors.hpp"
#include "base/system/start_threads.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

namespace microtrace {

void Poll::look() {
  constexpr std::chrono::milliseconds kInterval{20};
  const Clock::time_point now = Clock::now();
  if (now - last_ < kInterval) return;
  report_();
  last_ = Clock::now();
}

void for_each_run(
    std::uint64_t count, std::uint64_t run, const QueryOptions& options,
    const std::function<void(std::uint64_t first, std::uint64_t last, Poll& poll)>& f) {
  SharedRange range(count, run);
  std::atomic<std::uint64_t> done{0};
  std::mutex mutex;
  const std::function<void()> report = [&] {
    const std::scoped_lock lock(mutex);
    const bool goes_on =
        !range.is_ended() &&
        (!options.progress ||
         options.progress(count == 0 ? 1 : static_cast<double>(done) / static_cast<double>(count)));
    if (goes_on) return;
    range.end();
    throw Error(ErrorKind::canceled, "", "the query was canceled");
  };
  const auto work = [&] {
    Poll poll(report);
    range.take([&](std::uint64_t first, std::uint64_t last) {
      f(first, last, poll);
      done += last - first;
    });
  };
  const std::uint64_t wanted = thread_count(options.threads);
  const auto threads =
      static_cast<unsigned>(std::clamp<std::uint64_t>((count + run - 1) / run, 1, wanted));
  run_on_threads(threads, options.run_threads, work);
  range.rethrow();
  report();
}

}  // namespace microtrace
