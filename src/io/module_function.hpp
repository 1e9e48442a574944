#pragma once
/// Functions of modules that are loaded on demand.

#include <filesystem>
#include <string>

namespace microtrace::io {

struct Module {
  void* handle = nullptr;        ///< for dlsym; null if it can't be loaded
  std::filesystem::path path{};  ///< empty if there is no such file
  std::string complaint{};       ///< the reason why a file can't be loaded
  std::string sought{};          ///< the searched folders, separated by commas, if there is no file
};

/// Loads the module with this file name from the first of module_folders() that has it.
[[nodiscard]] Module open_module(const char* file);

struct ModuleFunction {
  void* address = nullptr;
  std::string complaint{};  ///< if there is no function: the module and the searched folders
};

/// Opens the module and looks up the function.
[[nodiscard]] ModuleFunction find_module_function(const char* file, const char* function);

}  // namespace microtrace::io
