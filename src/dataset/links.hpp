#pragma once
/// Links in the folder of a data set.

#include <filesystem>

namespace microtrace {

/// Throws Error (usage) if the folder contains links to files, through which the data set would
/// overwrite other files. Links to folders are followed.
void refuse_links(const std::filesystem::path& folder);

}  // namespace microtrace
