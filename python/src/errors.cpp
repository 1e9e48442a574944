#include "base/system/free_memory.hpp"
#include "common.hpp"

#include <exception>
#include <new>

namespace microtrace::python {

nb::object member(const char* module, const char* name) {
  return nb::module_::import_((std::string("microtrace.") + module).c_str()).attr(name);
}

namespace {

/// Converts text that may contain bytes that are not UTF-8, such as parts of file names. Python
/// represents these bytes by surrogates, as in paths.
nb::object text_of(const std::string& text) {
  return nb::steal(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape"));
}

/// Converts a path as Python's os.fsdecode() does, also if the encoding of paths is not UTF-8.
nb::object path_of(const std::string& path) {
  return nb::steal(
      PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<Py_ssize_t>(path.size())));
}

}  // namespace

nb::object to_python(const Diagnostic& diagnostic) {
  return member("errors", "Diagnostic")(path_of(diagnostic.file), diagnostic.line,
                                        diagnostic.column, text_of(diagnostic.pointer),
                                        text_of(diagnostic.message), text_of(diagnostic.text()));
}

nb::list to_python(const std::vector<Diagnostic>& diagnostics) {
  nb::list result;
  for (const Diagnostic& diagnostic : diagnostics) result.append(to_python(diagnostic));
  return result;
}

namespace {

/// Sets the Python exception for an error.
void set_exception(ErrorKind kind, const Diagnostic& diagnostic) {
  const nb::object exception = member("errors", "error_of")(
      static_cast<int>(kind), to_python(diagnostic), diagnostic.system_error);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
}

/// Sets the Python exception for an exception of C++. Rethrows those that nanobind converts.
void set_exception_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    set_exception(error.kind(), error.diagnostic());
  } catch (const std::bad_alloc&) {
    Diagnostic diagnostic;
    diagnostic.message = out_of_memory();
    set_exception(ErrorKind::limit, diagnostic);
  }
}

}  // namespace

void bind_errors(nb::module_& /*module*/) {
  nb::register_exception_translator([](const std::exception_ptr& thrown, void* /*payload*/) {
    try {
      const Call call;  // the one that failed has ended
      set_exception_of(thrown);
    } catch (nb::python_error& error) {
      error.restore();
    }
  });
}

}  // namespace microtrace::python
