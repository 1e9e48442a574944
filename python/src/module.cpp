/// The binding of the library to Python. Everything here is internal to the package microtrace,
/// whose Python files are the public interface.

#include "common.hpp"

#include <microtrace/version.h>

NB_MODULE(_core, module) {
  using namespace microtrace::python;
  module.attr("version") = MICROTRACE_VERSION_TEXT;
  bind_errors(module);
  bind_images(module);
  bind_memory(module);
  bind_scenes(module);
  bind_rays(module);
  bind_pictures(module);
  bind_solids(module);
}
