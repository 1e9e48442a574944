#pragma once
/// The control groups (cgroups) of this process, by which containers and clusters limit memory and
/// processors.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace microtrace {

enum class CgroupVersion : std::uint8_t { v1, v2 };

/// Calls visit(folder, version) for each group of this process that may have the controller, such
/// as "memory": for the root of the mount, which is the group itself in a container, and for the
/// groups below it. A folder may lack the files of the controller or not exist. `root` is the
/// folder that contains proc and sys.
void for_each_control_group(
    const std::filesystem::path& root, std::string_view controller,
    const std::function<void(const std::filesystem::path& folder, CgroupVersion version)>& visit);

}  // namespace microtrace
