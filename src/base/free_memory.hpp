#pragma once
#include <cstdint>
#include <filesystem>

namespace microtrace {

/// Bytes that this process may still take before the system or one of its control groups (cgroups
/// of version 1 or 2) runs short. `root` is where /proc and /sys lie.
[[nodiscard]] std::uint64_t free_memory(const std::filesystem::path& root = "/");

}  // namespace microtrace
