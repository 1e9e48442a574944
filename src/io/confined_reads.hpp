#pragma once
/// Restricts the files that a scene names to its folder and to folders that the user allows.

#include <filesystem>
#include <optional>
#include <vector>

namespace microtrace::io {

/// True if the file is in one of the folders or below. Symbolic links and ".." are resolved in
/// both, as far as the files exist.
[[nodiscard]] bool lies_within(const std::vector<std::filesystem::path>& folders,
                               const std::filesystem::path& path);

/// During its lifetime, read_file() on this thread reads only files in these folders or below;
/// symbolic links that lead elsewhere are refused. If there are several objects, the last one
/// counts.
class ConfinedReads {
 public:
  /// `own` is the scene's folder, empty for the current one.
  ConfinedReads(const std::filesystem::path& own,
                const std::vector<std::filesystem::path>& allowed);
  ~ConfinedReads();
  ConfinedReads(const ConfinedReads&) = delete;
  ConfinedReads& operator=(const ConfinedReads&) = delete;

  /// Throws Error unless this thread may read the file or has no restrictions. Must be called
  /// before the file is opened, so that no device is opened, and again with its descriptor, because
  /// the file may have been replaced in between.
  static void require(const std::filesystem::path& path, std::optional<int> descriptor);

 private:
  std::vector<std::filesystem::path> folders_;
  const ConfinedReads* former_;
};

}  // namespace microtrace::io
