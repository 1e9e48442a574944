/// Binds the library to Python. All bindings are internal to the package microtrace; its Python
/// files are the public interface.

#include "common.hpp"

#include <microtrace/version.h>

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
}
