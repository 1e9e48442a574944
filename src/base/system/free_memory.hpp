#pragma once
#include <cstdint>
#include <filesystem>

namespace microtrace {

/// Returns the number of bytes that this process can still allocate before the system or one of the
/// process's control groups (cgroups version 1 or 2) runs out of memory, or the process exceeds its
/// limits (RLIMIT_AS, RLIMIT_DATA). `root` is the folder that contains proc and sys.
[[nodiscard]] std::uint64_t free_memory(const std::filesystem::path& root = "/");

/// Returns true if the address space of this process is limited (ulimit -v).
[[nodiscard]] bool has_limited_address_space();

/// Returns the message of an allocation that failed, with the limit of the process to raise, if
/// there is one. Allocates nothing.
[[nodiscard]] const char* out_of_memory();

}  // namespace microtrace
