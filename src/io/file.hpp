#pragma once
/// Whole files into memory.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace microtrace::io {

/// No input file is larger; a scene of that size has long outgrown memory.
inline constexpr std::size_t max_file_size = std::size_t{1} << 30;

/// The bytes of a regular file, a pipe or a device. Throws Error: io for a file that is missing, a
/// directory or unreadable, limit for one of more than `limit` bytes. The size that the file claims
/// is checked before memory is taken, and a file without one grows with what was read. `inspect`
/// sees the first bytes (64 KiB, or all of a smaller file) before the rest is read, and may throw
/// to spare the reading of a file that can't be right.
[[nodiscard]] std::string read_file(const std::filesystem::path& path, std::size_t limit,
                                    const std::function<void(std::string_view)>& inspect = {});

/// The bytes of a regular file, for what another file names: a pipe could keep its reader waiting
/// forever, and a device has no end. Throws Error: io for any other kind too.
[[nodiscard]] std::string read_regular_file(const std::filesystem::path& path, std::size_t limit);

/// The same as read_file for what is left in an open descriptor; `name` stands in messages.
[[nodiscard]] std::string read_descriptor(int descriptor, const std::string& name,
                                          std::size_t limit,
                                          const std::function<void(std::string_view)>& inspect);

/// Tells ReadFiles of a file that a scene names, though it is not read.
void note_unread_file(const std::filesystem::path& path);

}  // namespace microtrace::io
