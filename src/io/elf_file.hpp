#pragma once
/// Checks object files before the dynamic linker maps them.

#include <filesystem>
#include <string>

namespace microtrace::io {

/// Returns the reason why the file can't be mapped as a shared library of this machine. Either it
/// is not such a library, or it is truncated, so access to the missing part would raise SIGBUS.
/// Returns an empty text if the file is valid.
[[nodiscard]] std::string damage_of_elf_file(const std::filesystem::path& path);

}  // namespace microtrace::io
