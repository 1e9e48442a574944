#pragma once
#include <filesystem>

namespace microtrace::cli {

/// A folder that is removed, with its files, at the end and by signals that end the program.
class TemporaryFolder {
 public:
  /// Throws Error (io).
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int slot_;
};

}  // namespace microtrace::cli
