#include "base/start_threads.hpp"

#include "float_environment.hpp"

#include <latch>
#include <new>
#include <system_error>

namespace microtrace {

std::vector<std::jthread> start_threads(unsigned count, const std::function<void()>& work) {
  std::vector<std::jthread> threads;
  try {
    threads.reserve(count);
    while (threads.size() < count) {
      threads.emplace_back([work] {
        const FloatEnvironment environment;
        work();
      });
    }
  } catch (const std::system_error&) {
  } catch (const std::bad_alloc&) {
  }
  return threads;
}

unsigned run_on_threads(unsigned count, const HostThreads& host,
                        const std::function<void()>& work) {
  const auto work_exactly = [&] {
    const FloatEnvironment environment;
    work();
  };
  if (host) {
    host(count, work_exactly);
    return 0;
  }
  const std::vector<std::jthread> started = start_threads(count - 1, work);
  work_exactly();
  return count - 1 - static_cast<unsigned>(started.size());
}

bool can_start_threads(unsigned count) {
  std::latch end(1);
  const std::vector<std::jthread> threads = start_threads(count, [&end] { end.wait(); });
  end.count_down();
  return threads.size() == count;
}

}  // namespace microtrace
