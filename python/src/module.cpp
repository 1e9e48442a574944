/// Binds the library to Python. All bindings are internal to the package microtrace; its Python
/// files are the public interface.

#include "common.hpp"

#include <microtrace/version.h>

namespace {

/// Makes the module's classes refuse pickling. By default, the protocols 0 and 1 would make objects
/// that are never initialized.
void refuse_pickling(nanobind::module_& module) {
  const auto refuse = [](nanobind::handle self, const nanobind::args& /*protocol*/) {
    PyErr_Format(PyExc_TypeError, "cannot pickle '%s' object", Py_TYPE(self.ptr())->tp_name);
    throw nanobind::python_error();
  };
  const nanobind::object method =
      nanobind::cpp_function(refuse, nanobind::name("__reduce_ex__"), nanobind::is_method());
  const nanobind::object names = module.attr("__dict__");
  for (const auto& [name, value] : nanobind::borrow<nanobind::dict>(names)) {
    if (nanobind::type_check(value)) nanobind::setattr(value, "__reduce_ex__", method);
  }
}

}  // namespace

NB_MODULE(_core, module) {
  using namespace microtrace::python;
  module.attr("version") = MICROTRACE_VERSION_TEXT;
  bind_errors(module);
  bind_images(module);
  bind_memory(module);
  bind_threads(module);
  bind_scenes(module);
  bind_rays(module);
  bind_pictures(module);
  bind_solids(module);
  bind_datasets(module);
  bind_viewer(module);
  refuse_pickling(module);
}
