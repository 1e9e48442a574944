/// Binds the library to Python. All bindings are internal to the package microtrace; its Python
/// files are the public interface.

#include "common.hpp"

#include <microtrace/version.h>

#include <vector>

namespace {

/// Makes the module's classes refuse pickling. By default, the protocols 0 and 1 would make objects
/// that are never initialized.
void refuse_pickling(nanobind::module_& module) {
  const auto refuse = [](nanobind::handle self, const nanobind::args& /*protocol*/) {
    PyErr_Format(PyExc_TypeError, "cannot pickle '%s' object", nanobind::inst_name(self).c_str());
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

NB_MODULE(unchecked_core, module) {
  using namespace microtrace::python;
  module.attr("version") = MICROTRACE_VERSION_TEXT;
  // Threads that still run at the exit keep objects alive, which is no fault of theirs.
  nanobind::set_leak_warnings(false);
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

namespace {

/// Fails in subinterpreters. nanobind would replace the types of the main interpreter there, and
/// Python itself refuses the module only in subinterpreters with their own lock. Python runs the
/// module's steps again if the module was removed from sys.modules.
int require_first_import(PyObject* /*module*/) {
  if (PyInterpreterState_GetID(PyInterpreterState_Get()) != 0) {
    PyErr_SetString(PyExc_ImportError,
                    "microtrace can't be imported in a subinterpreter; import it in the main "
                    "interpreter, or use separate processes");
    return -1;
  }
  static bool is_imported = false;
  if (is_imported) {
    PyErr_SetString(PyExc_ImportError,
                    "microtrace can't be imported again by this process after its removal from "
                    "sys.modules; leave it there");
    return -1;
  }
  is_imported = true;
  return 0;
}

}  // namespace

/// Python calls this to import the module. The steps that initialize the module follow a check,
/// which must not be here, because from Python 3.13 on, this function runs in the main interpreter.
extern "C" NB_EXPORT PyObject* PyInit__core() {
  static std::vector<PyModuleDef_Slot> slots;
  PyObject* object = PyInit_unchecked_core();
  if (object == nullptr || !slots.empty()) return object;
  auto* definition = reinterpret_cast<PyModuleDef*>(object);
  slots.push_back({Py_mod_exec, reinterpret_cast<void*>(require_first_import)});
  const PyModuleDef_Slot* slot = definition->m_slots;
  for (; slot->slot != 0; ++slot) slots.push_back(*slot);
  slots.push_back(*slot);
  definition->m_slots = slots.data();
  return object;
}
