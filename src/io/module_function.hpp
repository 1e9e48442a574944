#pragma once
/// Functions of modules that are loaded on need.

#include <string>

namespace microtrace::io {

struct ModuleFunction {
  void* address = nullptr;
  std::string complaint{};  ///< why there is none: the module and the folders where it was sought
};

/// Loads the module of that file name from the first of module_folders() that has it, and finds
/// the function in it.
[[nodiscard]] ModuleFunction find_module_function(const char* file, const char* function);

}  // namespace microtrace::io
