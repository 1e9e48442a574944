#pragma once
/// Looks up functions in modules that are loaded on demand.

#include <filesystem>
#include <string>

namespace microtrace::io {

struct Module {
  void* handle = nullptr;        ///< handle for dlsym; null if the module can't be loaded
  std::filesystem::path path{};  ///< empty if no file was found
  std::string complaint{};       ///< reason why the file can't be loaded
  std::string sought{};          ///< searched folders, separated by commas, if no file was found
};

/// Loads the module with this file name from the first folder of module_folders() that contains it.
/// Throws Error (limit) if there is too little memory for it, and Error (io) if too many files are
/// open.
[[nodiscard]] Module open_module(const char* file);

struct ModuleFunction {
  void* address = nullptr;
  std::string complaint{};  ///< states the module and the searched folders if there is no function
};

/// Opens the module and looks up the function. Throws Error as open_module() does.
[[nodiscard]] ModuleFunction find_module_function(const char* file, const char* function);

}  // namespace microtrace::io
