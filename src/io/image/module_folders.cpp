#include "io/image/module_folders.hpp"

#include <cstdlib>

namespace microtrace::io {

namespace fs = std::filesystem;

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

}  // namespace microtrace::io
