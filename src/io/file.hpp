#pragma once
/// Reads whole files into memory.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <sys/stat.h>

namespace microtrace::io {

/// Maximum size of an input file. Larger scenes would not fit in memory.
inline constexpr std::size_t kMaxFileSize = std::size_t{1} << 30;

/// Returns the bytes of a regular file, a pipe or a device. Throws Error: io for a missing file, a
/// directory or an unreadable file; limit if there are more than `limit` bytes. The reported size
/// is checked before memory is allocated. For files without a reported size, the buffer grows.
/// `inspect` receives the first bytes (64 KiB, or all of a smaller file) before the rest is read.
/// It may throw to reject the file early.
[[nodiscard]] std::string read_file(const std::filesystem::path& path, std::size_t limit,
                                    const std::function<void(std::string_view)>& inspect = {});

/// Does the same for a file that must be regular, as one that is named by another file: a pipe
/// could block forever, and a device has no end. Throws Error (io) for other kinds of files.
[[nodiscard]] std::string read_regular_file(
    const std::filesystem::path& path, std::size_t limit,
    const std::function<void(std::string_view)>& inspect = {});

/// Like read_file, but reads the rest of an open descriptor. Error messages use `name`.
[[nodiscard]] std::string read_descriptor(int descriptor, const std::string& name,
                                          std::size_t limit,
                                          const std::function<void(std::string_view)>& inspect);

/// Records in ReadFiles a file that a scene names but that is not read.
void note_unread_file(const std::filesystem::path& path);

/// Adds to the innermost ReadDigest of this thread something that affects the result as a file
/// does.
void add_to_read_digest(std::string_view what);

/// Returns the status of the file to which the path leads; "-" means standard output. Returns
/// nothing if there is no file.
[[nodiscard]] std::optional<struct stat> status_of_target(const std::filesystem::path& path);

}  // namespace microtrace::io
