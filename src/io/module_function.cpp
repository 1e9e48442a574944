#include "io/module_function.hpp"

#include "base/system/float_environment.hpp"
#include "base/system/free_memory.hpp"
#include "io/elf_file.hpp"
#include "io/module_folders.hpp"

#include <microtrace/error.hpp>

#include <cerrno>
#include <dlfcn.h>
#include <sys/statvfs.h>
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
  return (has_limited_address_space() &&
          complaint.find("failed to map segment") != complaint.npos) ||
         complaint.find("annot allocate memory") != complaint.npos;
}

/// Explains why the dynamic linker can't load a module.
std::string explained(const std::string& complaint, const std::filesystem::path& path) {
  struct statvfs system {};
  const bool is_noexec = complaint.find("failed to map segment") != complaint.npos &&
                         ::statvfs(path.c_str(), &system) == 0 && (system.f_flag & ST_NOEXEC) != 0;
  return is_noexec ? "it is on a file system without permission to execute files (noexec)"
                   : complaint;
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
    if (result.handle == nullptr) result.complaint = explained(last_complaint(path.string()), path);
    const auto fail = [&](ErrorKind kind, const char* remedy, int number) {
      throw Error(kind, path.string(), "can't be loaded: " + result.complaint + remedy, number);
    };
    if (lacks_memory(result.complaint))
      fail(ErrorKind::limit, "; raise the limit of memory (ulimit -v)", ENOMEM);
    if (result.complaint.find("Too many open files") != result.complaint.npos)
      fail(ErrorKind::io, "; close some, or raise the limit of open files (ulimit -n)", EMFILE);
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
