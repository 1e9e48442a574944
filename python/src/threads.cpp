#include "base/shared_range.hpp"
#include "base/system/float_environment.hpp"
#include "base/system/processors.hpp"
#include "base/system/start_threads.hpp"
#include "common.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cxxabi.h>
#include <exception>
#include <mutex>
#include <new>
#include <pthread.h>
#include <string>
#include <thread>
#include <unistd.h>
#include <utility>

namespace microtrace::python {
namespace {

/// The time between two checks for signals.
constexpr std::chrono::milliseconds kPatience{50};

/// The number of items that a thread takes at a time.
constexpr std::size_t kBlock = 4096;

/// The number of this thread's calls that are running. Python code within a call may call others.
thread_local int own_calls = 0;

/// The calls that are running.
class Calls {
 public:
  explicit Calls(int count = 0) : count_(count) {}
  /// Returns false if the interpreter exits. The thread that makes it exit may still run calls.
  [[nodiscard]] bool begin() {
    const std::scoped_lock lock(mutex_);
    if (is_canceled()) return false;
    ++count_, ++own_calls;
    return true;
  }
  void end() {
    const std::scoped_lock lock(mutex_);
    --count_, --own_calls;
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
  int count_;
  std::thread::id exiting_;  // set before is_exiting_
  std::atomic<bool> is_exiting_ = false;
};

Calls calls;

/// Runs in a forked process. The calls of the parent's other threads don't end there, and one of
/// these threads may have locked the mutex.
void forget_calls() {
  new (&calls) Calls(own_calls);
}

/// Ends a daemon thread without a message while the interpreter exits.
[[noreturn]] void end_thread() {
  PyErr_SetNone(PyExc_SystemExit);
  throw nb::python_error();
}

/// Calls f(), in which the interpreter may end this thread if it exits. The thread then waits for
/// the end of the process instead, because nothing in C++ expects to be left in this way.
template <class F>
void stay_alive(const F& f) {
#ifdef __GLIBCXX__
  try {
    f();
  } catch (const abi::__forced_unwind&) {
    while (true) pause();
  }
#else
  f();
#endif
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

/// Releases the interpreter's lock while it exists.
class Unlocked {
 public:
  Unlocked() : state_(PyEval_SaveThread()) {}
  ~Unlocked() { lock(); }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

  /// Calls f() with the lock.
  template <class F>
  void with_lock(const F& f) {
    lock();
    f();
    state_ = PyEval_SaveThread();
  }

 private:
  void lock() {
    stay_alive([this] { PyEval_RestoreThread(state_); });
  }

  PyThreadState* state_;
};

Call::Call() {
  if (!calls.begin()) end_thread();
}

Call::~Call() {
  calls.end();
}

void bind_threads(nb::module_& module) {
  module.def("_cancel_all", [] {
    const Unlocked unlocked;
    calls.cancel();
  });
  nb::module_::import_("atexit").attr("register")(module.attr("_cancel_all"));
  pthread_atfork(nullptr, nullptr, forget_calls);
}

void run_unlocked(const std::function<void()>& f) {
  const Call call;
  const Unlocked unlocked;
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

void Caller::Errand::run() {
  PyObject *argument = PyFloat_FromDouble(number), *result = nullptr;
  if (argument != nullptr) stay_alive([&] { result = PyObject_CallOneArg(f.ptr(), argument); });
  use(result);
  Py_XDECREF(result);
  Py_XDECREF(argument);
  is_done = true;
}

template <class WithLock>
void Caller::serve(Errand* errand, const WithLock& with_lock) {
  if (calls.is_canceled()) is_canceled_ = is_exiting_ = true;
  if (is_canceled_) return;
  with_lock([&] {
    if (errand != nullptr) errand->run();
    // Only the main thread handles signals.
    if (PyErr_CheckSignals() != 0) is_interrupted_ = is_canceled_ = true;
  });
}

bool Caller::call(const nb::object& f, double number, const std::function<void(PyObject*)>& use) {
  Errand errand{.f = f, .number = number, .use = use};
  if (!waits_) {
    serve(&errand, [](const auto& run) {
      PyGILState_STATE state{};
      stay_alive([&] { state = PyGILState_Ensure(); });
      run();
      PyGILState_Release(state);
    });
    return errand.is_done;
  }
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return errand_ == nullptr; });
  errand_ = &errand;
  changed_.notify_all();
  changed_.wait(lock, [&] { return errand_ != &errand; });
  return errand.is_done;
}

void Caller::wait(Unlocked& unlocked) {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait_for(lock, kPatience, [&] { return is_done_ || errand_ != nullptr; });
    if (is_done_) return;
    Errand* const errand = errand_;
    lock.unlock();
    serve(errand, [&](const auto& run) { unlocked.with_lock(run); });
    lock.lock();
    if (errand == nullptr) continue;
    errand_ = nullptr;
    changed_.notify_all();
  }
}

void Caller::end() {
  const std::scoped_lock lock(mutex_);
  is_done_ = true;
  changed_.notify_all();
}

void run_interruptible(const std::function<void(Caller&)>& f) {
  const Call call;
  Caller caller;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      f(caller);
    } catch (...) {
      failure = std::current_exception();
    }
    caller.end();
  };
  {
    Unlocked unlocked;
    const auto threads = start_threads(1, work);
    if (threads.empty()) {
      require_stack();
      caller.waits_ = false;
      work();
    }
    caller.wait(unlocked);
  }
  if (caller.is_interrupted_) throw nb::python_error();
  if (caller.is_exiting_) end_thread();
  if (failure) std::rethrow_exception(failure);
}

void for_each_block(std::size_t count, unsigned threads,
                    const std::function<void(std::size_t, std::size_t)>& f) {
  SharedRange blocks(count, kBlock);
  const auto work = [&](const Caller* caller) {
    const FloatEnvironment environment;
    blocks.take([&](std::size_t first, std::size_t last) {
      if (caller != nullptr && caller->is_canceled()) return blocks.end();
      f(first, last);
    });
  };
  const std::size_t block_count = (count + kBlock - 1) / kBlock;
  if (block_count <= 1) {
    run_unlocked([&] { work(nullptr); });
  } else {
    run_interruptible([&](const Caller& caller) {
      const std::size_t wanted = thread_count(threads);
      const auto helpers = static_cast<unsigned>(std::min(wanted, block_count) - 1);
      const auto started = start_threads(helpers, [&] { work(&caller); });
      work(&caller);
    });
  }
  blocks.rethrow();
}

}  // namespace microtrace::python
