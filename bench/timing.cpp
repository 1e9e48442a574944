#include "timing.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <exception>
#include <limits>
#include <stdexcept>
#include <thread>

namespace microtrace::bench {
namespace {

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Because the variables are volatile, the multiplication happens at run time, in this thread's
// floating-point mode.
void require_denormals() {
  const volatile float least_normal = std::numeric_limits<float>::min();
  const volatile float least_denormal = std::numeric_limits<float>::denorm_min();
  const volatile float half = least_normal * 0.5F, twice = least_denormal * 2.0F;
  if (half == 0 || twice == 0) throw std::runtime_error("denormal numbers are flushed to zero");
}

}  // namespace

double seconds(unsigned threads, const std::function<void()>& f) {
  const auto now = threads == 1 ? processor_seconds : wall_seconds;
  const double begin = now();
  f();
  return now() - begin;
}

void split(unsigned threads, std::size_t size,
           const std::function<void(std::size_t, std::size_t)>& f) {
  const std::size_t part = (size / threads + 64) / 64 * 64;
  std::vector<std::exception_ptr> failures(threads);
  const auto work = [&](unsigned k) {
    try {
      require_denormals();
      const std::size_t begin = std::min(size, k * part);
      f(begin, std::min(size, begin + part));
      require_denormals();
    } catch (...) {
      failures[k] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (unsigned k = 1; k < threads; ++k) others.emplace_back(work, k);
    work(0);
  }
  for (const auto& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

}  // namespace microtrace::bench
