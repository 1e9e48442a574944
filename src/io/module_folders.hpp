#pragma once
/// Where the library's modules lie.

#include <filesystem>
#include <vector>

namespace microtrace::io {

/// The folders where modules are sought, the most wanted first. MICROTRACE_MODULE_PATH names the
/// only one if it is set. Otherwise they are, as the library is installed, at a fixed place
/// relative to the file that its code was loaded from; and, for programs that hold a static library
/// and lie elsewhere, where the package was when the program was built (microtraceConfig.cmake).
[[nodiscard]] std::vector<std::filesystem::path> module_folders();

}  // namespace microtrace::io
