#include "base/shared_range.hpp"
#include "base/system/float_environment.hpp"
#include "base/system/processors.hpp"
#include "base/system/start_threads.hpp"
#include "common.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <pthread.h>
#include <string>
#include <thread>

namespace microtrace::python {
namespace {

/// The time between two checks for signals.
constexpr std::chrono::milliseconds kPatience{50};

/// The number of items that a thread takes at a time.
constexpr std::size_t kBlock = 4096;

/// The calls that are running.
class Calls {
 public:
  /// Returns false if the interpreter exits. The thread that makes it exit may still run calls.
  [[nodiscard]] bool begin() {
    const std::scoped_lock lock(mutex_);
    if (is_canceled()) return false;
    ++count_;
    return true;
  }
  void end() {
    const std::scoped_lock lock(mutex_);
    --count_;
    changed_.notify_all();
  }

  /// Cancels the calls of other threads, also future ones. Waits until none is running, but only
  /// for some seconds.
  void cancel() {
    std::unique_lock lock(mutex_);
    exiting_ = std::this_thread::get_id();
    is_exiting_ = true;
    changed_.wait_for(lock, std::chrono::seconds(5), [&] { return count_ == 0; });
  }
  [[nodiscard]] bool is_canceled() const {
    return is_exiting_ && std::this_thread::get_id() != exiting_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int count_ = 0;
  std::thread::id exiting_;  // set before is_exiting_
  std::atomic<bool> is_exiting_ = false;
};

Calls calls;

/// Runs in a forked process. The calls of the parent's other threads don't end there, and one of
/// these threads may have locked the mutex.
void forget_calls() {
  new (&calls) Calls;
}

/// Ends a daemon thread without a message while the interpreter exits.
[[noreturn]] void end_thread() {
  PyErr_SetNone(PyExc_SystemExit);
  throw nb::python_error();
}

/// Throws Error (limit) if rays may overflow the calling thread's stack.
void require_stack() {
  if (free_stack() >= kStackSize) return;
  throw Error(ErrorKind::limit, "",
              "the stack of the calling thread has less than " + std::to_string(kStackSize >> 10U) +
                  " KiB left, and the system refuses to start another thread; raise the limit on "
                  "processes, or the stack size by threading.stack_size()");
}

}  // namespace

Call::Call() {
  if (!calls.begin()) end_thread();
}

Call::~Call() {
  calls.end();
}

void bind_threads(nb::module_& module) {
  module.def("_cancel_all", [] {
    const nb::gil_scoped_release release;
    calls.cancel();
  });
  nb::module_::import_("atexit").attr("register")(module.attr("_cancel_all"));
  pthread_atfork(nullptr, nullptr, forget_calls);
}

void run_unlocked(const std::function<void()>& f) {
  const Call call;
  const nb::gil_scoped_release release;
  if (free_stack() >= kStackSize) return f();
  std::exception_ptr failure;
  if (start_threads(1, [&] {
        try {
          f();
        } catch (...) {
          failure = std::current_exception();
        }
      }).empty())
    require_stack();
  if (failure) std::rethrow_exception(failure);
}

void run_interruptible(const std::function<void(const std::function<bool()>&)>& f) {
  const Call call;
  std::atomic<bool> is_canceled = false;
  const std::function<bool()> cancel = [&] { return is_canceled.load(); };
  std::mutex mutex;
  std::condition_variable ended;
  bool is_done = false;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      f(cancel);
    } catch (...) {
      failure = std::current_exception();
    }
    const std::scoped_lock lock(mutex);
    is_done = true;
    ended.notify_one();
  };
  bool is_interrupted = false, is_exiting = false;
  {
    const nb::gil_scoped_release release;
    const auto threads = start_threads(1, work);
    if (threads.empty()) {
      require_stack();
      work();
    }
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, kPatience, [&] { return is_done; })) {
      lock.unlock();
      if (calls.is_canceled()) {
        is_canceled = is_exiting = true;
      } else if (!is_interrupted) {
        const nb::gil_scoped_acquire acquire;
        is_interrupted = PyErr_CheckSignals() != 0;
        if (is_interrupted) is_canceled = true;
      }
      lock.lock();
    }
  }
  if (is_interrupted) throw nb::python_error();
  if (is_exiting) end_thread();
  if (failure) std::rethrow_exception(failure);
}

void for_each_block(std::size_t count, unsigned threads,
                    const std::function<void(std::size_t, std::size_t)>& f) {
  SharedRange blocks(count, kBlock);
  const auto work = [&](const std::function<bool()>& cancel) {
    const FloatEnvironment environment;
    blocks.take([&](std::size_t first, std::size_t last) {
      if (cancel()) return blocks.end();
      f(first, last);
    });
  };
  const std::size_t block_count = (count + kBlock - 1) / kBlock;
  if (block_count <= 1) {
    run_unlocked([&] { work([] { return false; }); });
  } else {
    run_interruptible([&](const std::function<bool()>& cancel) {
      const std::size_t wanted = thread_count(threads);
      const auto helpers = static_cast<unsigned>(std::min(wanted, block_count) - 1);
      const auto started = start_threads(helpers, [&] { work(cancel); });
      work(cancel);
    });
  }
  blocks.rethrow();
}

}  // namespace microtrace::python
