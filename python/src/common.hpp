#pragma once
/// Declarations that all parts of the binding share.

#include <microtrace/microtrace.hpp>

#include <functional>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <optional>
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

/// A call of a bound function. While it exists, the interpreter doesn't exit. An interpreter that
/// exits ends each other thread that waits for its lock, within whatever C++ function called
/// Python, and nanobind's objects abort the process when such a thread destroys them. Throws
/// SystemExit, which ends daemon threads without a message, if the interpreter exits.
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

/// Runs f() without the interpreter's lock, on a separate thread while this thread handles signals.
/// After Ctrl-C, `cancel` returns true and f() should return soon. KeyboardInterrupt is then
/// raised.
void run_interruptible(const std::function<void(const std::function<bool()>& cancel)>& f);

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
