#pragma once
/// Functions of modules that are loaded on need.

#include <filesystem>
#include <string>

namespace microtrace::io {

struct Module {
  void* handle = nullptr;        ///< dlsym's; null if it can't be loaded
  std::filesystem::path path{};  ///< empty if there is no such file
  std::string complaint{};       ///< of a file that can't be loaded: the reason
  std::string sought{};          ///< the folders where there is none, with commas between
};

/// Loads the module of that file name from the first of module_folders() that has it.
[[nodiscard]] Module open_module(const char* file);

struct ModuleFunction {
  void* address = nullptr;
  std::string complaint{};  ///< why there is none: the module and the folders where it was sought
};

/// Opens the module and finds the function in it.
[[nodiscard]] ModuleFunction find_module_function(const char* file, const char* function);

}  // namespace microtrace::io
