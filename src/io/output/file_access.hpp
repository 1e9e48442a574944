#pragma once
#include <filesystem>
#include <sys/stat.h>

namespace microtrace::io {

/// Gives a new file the owner, group, permissions and access control list of the file that it will
/// replace. Where the system refuses the group or the list, fewer users can access the new file,
/// not more. The file should be accessible only to its owner before.
void copy_access(const std::filesystem::path& from, const struct stat& status, int descriptor);

/// Returns true if a folder lets this process replace the file, which the sticky bit can forbid.
[[nodiscard]] bool may_replace(const std::filesystem::path& folder, const struct stat& file);

}  // namespace microtrace::io
