#pragma once
/// Declarations that all parts of the binding share.

#include <microtrace/microtrace.hpp>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <optional>
#include <thread>
#include <utility>

namespace microtrace::python {

namespace nb = nanobind;

/// An array of NumPy or another library, in CPU memory.
using AnyArray = nb::ndarray<nb::ro, nb::device::cpu>;

/// Returns the class or function `name` of the Python module microtrace.`module`.
nb::object member(const char* module, const char* name);

/// Converts a diagnostic to microtrace.errors.Diagnostic.
nb::object to_python(const Diagnostic& diagnostic);
nb::list to_python(const std::vector<Diagnostic>& diagnostics);

/// A call of a bound function. While it exists, the interpreter exits only after 5 s. An
/// interpreter that exits ends each other thread that waits for its lock, within whatever C++
/// function called Python, and nanobind's objects abort the process when such a thread destroys
/// them. Throws SystemExit, which ends daemon threads without a message, if the interpreter exits.
class Call {
 public:
  Call();
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
};

/// Belongs in the definition of each bound function that may run Python code or release the lock.
using WholeCall = nb::call_guard<Call>;

/// Runs f() without the interpreter's lock, on a separate thread if the calling thread's stack is
/// too small for tracing rays.
void run_unlocked(const std::function<void()>& f);

/// Does the same, and returns f().
template <class F>
auto result_unlocked(const F& f) {
  std::optional<decltype(f())> result;
  run_unlocked([&] { result.emplace(f()); });
  return *std::move(result);
}

/// The thread that called a bound function and waits for its end.
class Caller {
 public:
  /// True after Ctrl-C, and if the interpreter exits. The function should return soon.
  [[nodiscard]] bool is_canceled() const { return is_canceled_; }

  /// Calls the Python function `f` with a number, on the calling thread if it waits, and passes its
  /// result, or null with an exception set, to `use`, which must not throw. Returns false without
  /// calling it if the call of the bound function is canceled.
  [[nodiscard]] bool call(const nb::object& f, double number,
                          const std::function<void(PyObject* result)>& use);

 private:
  struct Errand {
    const nb::object& f;
    double number;
    const std::function<void(PyObject*)>& use;
    bool is_done = false;

    void run();
  };
  /// Runs an errand, unless it is null, and checks for signals, if the call isn't canceled.
  /// with_lock(f) must call f() with the interpreter's lock.
  template <class WithLock>
  void serve(Errand* errand, const WithLock& with_lock);

  friend void run_interruptible(const std::function<void(Caller&)>& f);
  /// Waits for end(). Runs errands, and checks for signals in between.
  void wait(class Unlocked& unlocked);
  void end();

  bool waits_ = true;  // false if the system refused a thread, so that the calling thread works
  std::mutex mutex_;
  std::condition_variable changed_;
  Errand* errand_ = nullptr;
  bool is_done_ = false, is_interrupted_ = false;
  std::atomic<bool> is_canceled_ = false, is_exiting_ = false;
};

/// Runs f() without the interpreter's lock, on a separate thread while this thread handles signals
/// and what f() asks of it. Raises KeyboardInterrupt after Ctrl-C.
void run_interruptible(const std::function<void(Caller& caller)>& f);

/// Calls f(first, last) for blocks that cover [0, count), on up to `threads` threads, without the
/// interpreter's lock. Ctrl-C stops it between blocks.
void for_each_block(std::size_t count, unsigned threads,
                    const std::function<void(std::size_t first, std::size_t last)>& f);

void bind_errors(nb::module_& module);
void bind_images(nb::module_& module);
void bind_memory(nb::module_& module);
void bind_threads(nb::module_& module);
void bind_scenes(nb::module_& module);
void bind_rays(nb::module_& module);
void bind_pictures(nb::module_& module);
void bind_solids(nb::module_& module);
void bind_datasets(nb::module_& module);
void bind_viewer(nb::module_& module);

}  // namespace microtrace::python
