#pragma once
#include <microtrace/microtrace.hpp>

#include <functional>

namespace microtrace::python {

/// Calls f(). Errors about the library's structs get Python's names of their members.
void with_python_names(const std::function<void()>& f);

}  // namespace microtrace::python
