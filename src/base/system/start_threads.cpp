#include "base/system/start_threads.hpp"

#include "base/system/float_environment.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <latch>
#include <memory>
#include <new>
#include <system_error>
#include <utility>

namespace microtrace {
namespace {

/// Addresses of a stack.
struct StackBounds {
  std::uintptr_t begin = 0, end = 0;
};

StackBounds bounds_of_stack() {
  pthread_attr_t attributes;
  if (::pthread_getattr_np(::pthread_self(), &attributes) != 0) return {};
  void* begin = nullptr;
  std::size_t size = 0;
  const bool is_known = ::pthread_attr_getstack(&attributes, &begin, &size) == 0;
  ::pthread_attr_destroy(&attributes);
  if (!is_known) return {};
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  return {.begin = address, .end = address + size};
}

void* run(void* work) {
  (*std::unique_ptr<std::function<void()>>(static_cast<std::function<void()>*>(work)))();
  return nullptr;
}

/// Starts a thread that runs and deletes `work`. Returns an error number.
int start(std::function<void()>* work, pthread_t& thread) {
  pthread_attr_t attributes;
  if (const int error = ::pthread_attr_init(&attributes); error != 0) return error;
  std::size_t size = 0;
  ::pthread_attr_getstacksize(&attributes, &size);
  ::pthread_attr_setstacksize(&attributes, std::max(size, kStackSize));
  const int error = ::pthread_create(&thread, &attributes, run, work);
  ::pthread_attr_destroy(&attributes);
  return error;
}

}  // namespace

std::size_t free_stack() {
  // Reading the bounds of the main thread's stack takes long.
  thread_local const StackBounds bounds = bounds_of_stack();
  const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  return here >= bounds.begin && here < bounds.end ? here - bounds.begin : 0;
}

Thread::Thread(std::function<void()> work) {
  auto owned = std::make_unique<std::function<void()>>(std::move(work));
  pthread_t thread{};
  if (const int error = start(owned.get(), thread); error != 0)
    throw std::system_error(error, std::generic_category());
  static_cast<void>(owned.release());  // the thread deletes it
  thread_ = thread;
}

Thread::Thread(Thread&& other) noexcept : thread_(std::exchange(other.thread_, std::nullopt)) {}

Thread::~Thread() {
  if (thread_) ::pthread_join(*thread_, nullptr);
}

void Thread::detach() {
  ::pthread_detach(*std::exchange(thread_, std::nullopt));
}

std::vector<Thread> start_threads(unsigned count, const std::function<void()>& work) {
  std::vector<Thread> threads;
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
    std::atomic<bool> is_done{false};
    host(count, [&] {
      work_exactly();
      is_done = true;
    });
    if (!is_done) throw Error(ErrorKind::usage, "run_threads", "returned without a call of work()");
    return 0;
  }
  const std::vector<Thread> started = start_threads(count - 1, work);
  work_exactly();
  return count - 1 - static_cast<unsigned>(started.size());
}

bool can_start_threads(unsigned count) {
  std::latch end(1);
  const std::vector<Thread> threads = start_threads(count, [&end] { end.wait(); });
  end.count_down();
  return threads.size() == count;
}

}  // namespace microtrace
