#include "io/module_function.hpp"

#include "base/system/float_environment.hpp"
#include "io/elf_file.hpp"
#include "io/module_folders.hpp"

#include <microtrace/error.hpp>

#include <dlfcn.h>
#include <sys/resource.h>
#include <system_error>

namespace microtrace::io {
namespace {

std::string last_complaint(const std::string& otherwise) {
  const char* reason = ::dlerror();
  return reason != nullptr ? reason : otherwise;
}

/// True if this complaint of the dynamic linker of glibc is about memory. A segment can't be mapped
/// for other reasons too, such as a file system without permission to execute.
bool lacks_memory(const std::string& complaint) {
  rlimit limit{};
  const bool is_limited = ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return (is_limited && complaint.find("failed to map segment") != complaint.npos) ||
         complaint.find("annot allocate memory") != complaint.npos;
}

}  // namespace

Module open_module(const char* file) {
  const FloatEnvironment environment;  // protects the tables that libraries compute when loaded
  Module result;
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path path = folder / file;
    result.sought += (result.sought.empty() ? "" : ", ") + folder.string();
    std::error_code error;
    if (!std::filesystem::exists(path, error)) continue;
    result.path = path;
    result.complaint = damage_of_elf_file(path);
    if (!result.complaint.empty()) break;
    result.handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (result.handle == nullptr) result.complaint = last_complaint(path.string());
    if (lacks_memory(result.complaint)) {
      throw Error(
          ErrorKind::limit, path.string(),
          "can't be loaded: " + result.complaint + "; raise the limit of memory (ulimit -v)");
    }
    break;
  }
  return result;
}

ModuleFunction find_module_function(const char* file, const char* function) {
  Module module = open_module(file);
  if (module.path.empty()) {
    const std::string place =
        module.sought.empty()
            ? "can't be sought, because the program's folder is unknown; set MICROTRACE_MODULE_PATH"
            : "is not in " + module.sought;
    return {.complaint = std::string("the module ") + file + " " + place};
  }
  if (module.handle != nullptr) {
    void* address = ::dlsym(module.handle, function);
    if (address != nullptr) return {.address = address};
    module.complaint = last_complaint("it belongs to another version");
  }
  return {.complaint =
              "the module " + module.path.string() + " can't be used: " + module.complaint};
}

}  // namespace microtrace::io
