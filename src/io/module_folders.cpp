#include "io/module_folders.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <link.h>
#include <string_view>
#include <sys/auxv.h>
#include <system_error>

/// Defined only in programs that CMake links with the static library.
extern "C" [[gnu::weak, gnu::visibility("hidden")]] const char microtrace_module_folder[];

namespace microtrace::io {
namespace {

namespace fs = std::filesystem;

/// Returns the current folder at the first call. Relative paths of the program and the library
/// refer to it, although the program may change the folder later.
const fs::path& folder_at_start() {
  static const fs::path folder = [] {
    std::error_code error;  // the folder may have been removed
    return fs::current_path(error);
  }();
  return folder;
}

/// Makes the first call when the library is loaded.
[[gnu::constructor]] void remember_folder() {
  static_cast<void>(folder_at_start());
}

/// Resolves symbolic links, because /usr/bin/microtrace may be a link to another prefix. Empty if
/// the file does not exist.
fs::path folder_of(const char* file) {
  std::error_code error;
  const fs::path path = fs::canonical(folder_at_start() / file, error);
  return error ? fs::path() : path.parent_path();
}

/// Returns the module folder relative to the program or the shared library that contains this
/// function. The dynamic linker knows the path of a shared library. For the program it uses argv,
/// which is unreliable. The program's path is therefore taken from the kernel.
fs::path beside_library() {
  Dl_info info{};
  link_map* object = nullptr;
  const auto here = reinterpret_cast<const void*>(&module_folders);
  const bool is_known =
      ::dladdr1(here, &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0;
  if (is_known && *object->l_name != 0) {
    const fs::path folder = folder_of(object->l_name);
    return folder.empty() ? folder : folder / "microtrace";
  }
  // NOLINTNEXTLINE(performance-no-int-to-ptr): getauxval() returns all values as integers
  const auto program = reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
  const fs::path folder = program != nullptr ? folder_of(program) : fs::path();
  return folder.empty() ? folder : (folder / MICROTRACE_MODULES_FROM_PROGRAM).lexically_normal();
}

}  // namespace

std::vector<fs::path> module_folders() {
  if (const char* named = std::getenv("MICROTRACE_MODULE_PATH"); named != nullptr && *named != 0) {
    return {named};
  }
  std::vector<fs::path> folders;
  if (fs::path beside = beside_library(); !beside.empty()) folders.push_back(std::move(beside));
  if (microtrace_module_folder != nullptr) folders.emplace_back(microtrace_module_folder);
  return folders;
}

}  // namespace microtrace::io
