#pragma once
/// Where the library's modules lie.

#include <filesystem>
#include <vector>

namespace microtrace::io {

/// The folders where a module may lie, the most wanted first: MICROTRACE_MODULE_PATH alone, if it
/// is set; else beside the program, where modules were installed, where they were built.
[[nodiscard]] std::vector<std::filesystem::path> module_folders();

}  // namespace microtrace::io
