#include "io/module_function.hpp"

#include "io/image/module_folders.hpp"

#include <dlfcn.h>
#include <filesystem>
#include <system_error>

namespace microtrace::io {

ModuleFunction find_module_function(const char* file, const char* function) {
  std::string sought;
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path path = folder / file;
    sought += (sought.empty() ? "" : ", ") + folder.string();
    std::error_code error;
    if (!std::filesystem::exists(path, error)) continue;
    void* module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* address = module != nullptr ? ::dlsym(module, function) : nullptr;
    if (address != nullptr) return {.address = address};
    const char* reason = ::dlerror();
    return {.complaint = "the module " + path.string() + " can't be used: " +
                         (reason != nullptr ? reason : "it is of another version")};
  }
  return {.complaint = std::string("the module ") + file + " is not in " + sought};
}

}  // namespace microtrace::io
