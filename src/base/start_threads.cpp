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

bool can_start_threads(unsigned count) {
  std::latch end(1);
  const std::vector<std::jthread> threads = start_threads(count, [&end] { end.wait(); });
  end.count_down();
  return threads.size() == count;
}

}  // namespace microtrace
