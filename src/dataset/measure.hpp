#pragma once
/// Compares files with their records.

#include <microtrace/dataset.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace microtrace {

/// Returns true if a file exists and has its recorded size.
[[nodiscard]] bool has_size(const std::filesystem::path& folder, const DatasetFile& file);

/// Reads a file in parts. Nothing if it doesn't exist. Throws Error (io).
[[nodiscard]] std::optional<DatasetFile> measure(const std::filesystem::path& folder,
                                                 const std::string& name);

}  // namespace microtrace
