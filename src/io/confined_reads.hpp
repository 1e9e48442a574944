#pragma once
/// Restricts the files that a scene may name to its own folder and to folders that the user allows.

#include <filesystem>
#include <optional>
#include <vector>

namespace microtrace::io {

/// True if the file is in one of the folders or below. Symbolic links and ".." are resolved in the
/// folders and, as far as it exists, in the path.
[[nodiscard]] bool lies_within(const std::vector<std::filesystem::path>& folders,
                               const std::filesystem::path& path);

/// During its lifetime, read_file() on this thread reads only files in these folders or below. It
/// refuses symbolic links that lead elsewhere. If several objects exist, the most recent one
/// applies.
class ConfinedReads {
 public:
  /// `own` is the scene's folder. An empty path means the current folder.
  ConfinedReads(const std::filesystem::path& own,
                const std::vector<std::filesystem::path>& allowed);
  ~ConfinedReads();
  ConfinedReads(const ConfinedReads&) = delete;
  ConfinedReads& operator=(const ConfinedReads&) = delete;

  /// Throws Error unless this thread has no restrictions or may read the file. Callers check twice.
  /// The check before opening keeps devices from being opened. The check with the descriptor
  /// detects a file that was replaced in between.
  static void require(const std::filesystem::path& path, std::optional<int> descriptor);

 private:
  std::vector<std::filesystem::path> folders_;
  const ConfinedReads* former_;
};

}  // namespace microtrace::io
