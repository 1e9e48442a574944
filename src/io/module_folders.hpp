#pragma once
/// Finds the library's modules.

#include <filesystem>
#include <vector>

namespace microtrace::io {

/// The folders to search for modules, in order. If MICROTRACE_MODULE_PATH is set, only that folder.
/// Otherwise a folder relative to the file that contains the library's code; and, for programs with
/// a static library at another place, the package's module folder when the program was built
/// (microtraceConfig.cmake).
[[nodiscard]] std::vector<std::filesystem::path> module_folders();

}  // namespace microtrace::io
