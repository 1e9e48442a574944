#pragma once
/// Finds the library's modules.

#include <filesystem>
#include <vector>

namespace microtrace::io {

/// Returns the folders to search for modules, in order. If MICROTRACE_MODULE_PATH is set, it is the
/// only folder. Otherwise the first folder is relative to the file that contains the library's
/// code. Programs that link the static library may be elsewhere, so they also search the package's
/// module folder, as it was when they were built (microtraceConfig.cmake).
[[nodiscard]] std::vector<std::filesystem::path> module_folders();

}  // namespace microtrace::io
