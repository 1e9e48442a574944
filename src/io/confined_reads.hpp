#pragma once
/// Files that a scene names lie in its folder, or in others that the user allows.

#include <filesystem>
#include <optional>
#include <vector>

namespace microtrace::io {

/// Whether the file lies in one of the folders or below, with ".." and symbolic links resolved in
/// both, as far as there are such files.
[[nodiscard]] bool lies_within(const std::vector<std::filesystem::path>& folders,
                               const std::filesystem::path& path);

/// While it lives, read_file() reads only files in these folders or below on this thread; whatever
/// symbolic links lead out of them is refused. The last one made counts.
class ConfinedReads {
 public:
  /// `own` is the scene's folder, empty for the current one.
  ConfinedReads(const std::filesystem::path& own,
                const std::vector<std::filesystem::path>& allowed);
  ~ConfinedReads();
  ConfinedReads(const ConfinedReads&) = delete;
  ConfinedReads& operator=(const ConfinedReads&) = delete;

  /// Throws Error unless this thread may read the file, or is confined by nothing. To be called
  /// before the file is opened, lest a device is, and then with its descriptor: another file may
  /// have taken its place in between.
  static void require(const std::filesystem::path& path, std::optional<int> descriptor);

 private:
  std::vector<std::filesystem::path> folders_;
  const ConfinedReads* former_;
};

}  // namespace microtrace::io
