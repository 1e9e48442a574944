#pragma once
/// Restricts scenes to files in their own folder and in folders that the user allows.

#include <filesystem>
#include <optional>
#include <vector>

namespace microtrace::io {

/// Returns true if the file is in one of the folders or below. Resolves symbolic links and ".." in
/// the folders and in the path, as far as they exist.
[[nodiscard]] bool lies_within(const std::vector<std::filesystem::path>& folders,
                               const std::filesystem::path& path);

/// During its lifetime, read_file() on this thread reads only files in these folders or below. It
/// rejects symbolic links that lead elsewhere. If several objects exist, only the most recent one
/// applies.
class ConfinedReads {
 public:
  /// `own` is the scene's folder. An empty path means the current folder.
  ConfinedReads(const std::filesystem::path& own, std::vector<std::filesystem::path> allowed);
  ~ConfinedReads();
  ConfinedReads(const ConfinedReads&) = delete;
  ConfinedReads& operator=(const ConfinedReads&) = delete;

  /// Throws Error if this thread must not read the file. Callers check twice: before opening, so
  /// that devices are not opened, and then with the descriptor, because the file may have been
  /// replaced in between.
  static void require(const std::filesystem::path& path, std::optional<int> descriptor);

 private:
  std::vector<std::filesystem::path> folders_;
  const ConfinedReads* former_;
};

}  // namespace microtrace::io
