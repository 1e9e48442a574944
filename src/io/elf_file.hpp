#pragma once
/// Object files that the dynamic linker is to map.

#include <filesystem>
#include <string>

namespace microtrace::io {

/// Why the file can't be mapped as a shared object of this machine's word size: it is no such file,
/// or it ends before its parts do, and what touches the missing ones dies of SIGBUS. Empty if
/// nothing is wrong.
[[nodiscard]] std::string damage_of_elf_file(const std::filesystem::path& path);

}  // namespace microtrace::io
