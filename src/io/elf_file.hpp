#pragma once
/// Checks object files before the dynamic linker maps them.

#include <filesystem>
#include <string>

namespace microtrace::io {

/// The reason why the file can't be mapped as a shared object of this machine's word size: it is
/// not such a file, or it is truncated, which would cause SIGBUS on access to the missing part.
/// Empty if the file is valid.
[[nodiscard]] std::string damage_of_elf_file(const std::filesystem::path& path);

}  // namespace microtrace::io
