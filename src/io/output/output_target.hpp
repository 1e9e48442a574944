#pragma once
/// Where output files are written to: checks before rendering, links, and open descriptors.

#include <filesystem>
#include <optional>
#include <string_view>
#include <sys/stat.h>

namespace microtrace::io {

/// Follows symbolic links in the last component of the path, as AtomicFile does. The file at the
/// end of the links need not exist.
[[nodiscard]] std::filesystem::path follow_links(std::filesystem::path path);

/// Throws Error(io) if creating an AtomicFile for this target would fail now. Has no side effects.
void check_target(const std::filesystem::path& target);

/// Returns true if the target is written directly, because it is an open descriptor or an existing
/// file that is not regular.
[[nodiscard]] bool is_stream(const std::filesystem::path& target);

/// Returns the open descriptor that a path without links names: 1 for "-", N for /dev/fd/N and
/// /proc/self/fd/N. /dev/stdout is a link to the latter.
[[nodiscard]] std::optional<int> descriptor_number(const std::filesystem::path& path);

/// Returns the folder of a file.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& path);

/// What is at the place of a new file.
struct ReplacedFile {
  std::optional<struct stat> existing{};  ///< status of the file, if there is one
  bool is_mounted = false;  ///< true if the file is a mount point, which can only be overwritten
};

/// Checks that the file, a path without links, can be replaced. Throws Error(io) otherwise. `named`
/// is the path for messages.
ReplacedFile check_file(const std::filesystem::path& named, const std::filesystem::path& target);

/// The remedy for a descriptor that isn't open for writing.
inline constexpr std::string_view kOpenForWriting = "open that descriptor for writing";

/// Throws Error(io) with the path, the system's reason and the remedy.
[[noreturn]] void fail_to_write(const std::filesystem::path& named, int error,
                                std::string_view remedy);

}  // namespace microtrace::io
