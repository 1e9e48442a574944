#pragma once
/// Reads the list of a data set's files.

#include <microtrace/dataset.hpp>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

namespace microtrace {

inline constexpr std::string_view kManifest = "manifest.json";

/// Reads `manifest.json`, in which each file has a line, because a JSON document may have only 2^24
/// values. A manifest that doesn't exist has no files.
class ManifestReader {
 public:
  /// Throws Error (io) if the manifest of this data set is not a regular file.
  explicit ManifestReader(const std::filesystem::path& folder);

  /// Returns the next file; nothing after the last one. Throws Error (io).
  [[nodiscard]] std::optional<DatasetFile> next();

 private:
  std::filesystem::path path_;
  std::ifstream lines_;
  bool is_ended_ = false;
};

}  // namespace microtrace
