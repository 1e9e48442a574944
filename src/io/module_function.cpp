#include "io/module_function.hpp"

#include "float_environment.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <system_error>
#include <vector>

namespace microtrace::io {
namespace {

namespace fs = std::filesystem;

/// Where a module may lie, the most wanted folder first.
std::vector<fs::path> module_folders() {
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("MICROTRACE_MODULE_PATH"); named != nullptr && *named != 0) {
    folders.emplace_back(named);
    return folders;
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    folders.push_back((program.parent_path() / MICROTRACE_MODULES_FROM_PROGRAM).lexically_normal());
  }
  folders.emplace_back(MICROTRACE_INSTALLED_MODULES);
  folders.emplace_back(MICROTRACE_BUILT_MODULES);
  return folders;
}

std::string last_complaint(const std::string& otherwise) {
  const char* reason = ::dlerror();
  return reason != nullptr ? reason : otherwise;
}

}  // namespace

Module open_module(const char* file) {
  const FloatEnvironment environment;  // libraries make tables when they are loaded
  Module result;
  for (const fs::path& folder : module_folders()) {
    const fs::path path = folder / file;
    result.sought += (result.sought.empty() ? "" : ", ") + folder.string();
    std::error_code error;
    if (!fs::exists(path, error)) continue;
    result.path = path;
    result.handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (result.handle == nullptr) result.complaint = last_complaint(path.string());
    break;
  }
  return result;
}

ModuleFunction find_module_function(const char* file, const char* function) {
  Module module = open_module(file);
  if (module.path.empty()) {
    return {.complaint = std::string("the module ") + file + " is not in " + module.sought};
  }
  if (module.handle != nullptr) {
    void* address = ::dlsym(module.handle, function);
    if (address != nullptr) return {.address = address};
    module.complaint = last_complaint("it is of another version");
  }
  return {.complaint =
              "the module " + module.path.string() + " can't be used: " + module.complaint};
}

}  // namespace microtrace::io
