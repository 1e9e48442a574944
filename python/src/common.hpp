#pragma once
/// What all parts of the binding share.

#include <microtrace/microtrace.hpp>

#include <functional>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

namespace microtrace::python {

namespace nb = nanobind;

/// An array of NumPy or another library, in memory of the processor.
using AnyArray = nb::ndarray<nb::ro, nb::device::cpu>;

/// The class or function `name` of microtrace.MODULE.
nb::object member(const char* module, const char* name);

/// microtrace.errors.Diagnostic.
nb::object to_python(const Diagnostic& diagnostic);

/// Runs f() without the interpreter's lock, on a thread of its own if f can take long, while this
/// one handles signals: Ctrl-C ends f() soon after `cancel` returns true, and is then raised.
void run_interruptible(const std::function<void(const std::function<bool()>& cancel)>& f);

/// f(first, last) for blocks that cover [0, count), on up to `threads` threads without the
/// interpreter's lock. Ctrl-C ends it between blocks.
void for_each_block(std::size_t count, unsigned threads,
                    const std::function<void(std::size_t first, std::size_t last)>& f);

void bind_errors(nb::module_& module);
void bind_images(nb::module_& module);
void bind_memory(nb::module_& module);
void bind_scenes(nb::module_& module);
void bind_rays(nb::module_& module);
void bind_pictures(nb::module_& module);
void bind_solids(nb::module_& module);

}  // namespace microtrace::python
