#pragma once
/// Records which files were read, so that a program can avoid overwriting them.

#include <microtrace/export.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace microtrace {

/// A file's device and inode numbers, which are the same for all names and links of the file.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;

/// Returns the identity of the regular file to which the path leads; "-" means standard output.
/// Returns nothing if there is no file or if it is not a regular file.
[[nodiscard]] MICROTRACE_EXPORT std::optional<FileIdentity> identity_of(
    const std::filesystem::path& path);

/// The members differ after a file was written or replaced. They are 0 if there is no regular file.
struct FileState {
  FileIdentity identity{};
  std::int64_t size = 0;                      ///< bytes
  std::int64_t seconds = 0, nanoseconds = 0;  ///< time of the last change
  [[nodiscard]] bool operator==(const FileState&) const = default;
};

/// Returns the state of the file to which the path leads; "-" means standard output.
[[nodiscard]] MICROTRACE_EXPORT FileState state_of(const std::filesystem::path& path);

/// Returns true if both paths lead to the same file, even if the file does not exist yet.
[[nodiscard]] MICROTRACE_EXPORT bool are_same_target(const std::filesystem::path& a,
                                                     const std::filesystem::path& b);

/// During its lifetime, records all files that the library reads on this thread, including standard
/// input, and all files that scenes name, even if they don't exist. If several objects exist on a
/// thread, only the most recent one records.
class MICROTRACE_EXPORT ReadFiles {
 public:
  ReadFiles();
  ~ReadFiles();
  ReadFiles(const ReadFiles&) = delete;
  ReadFiles& operator=(const ReadFiles&) = delete;

  /// Returns the name under which the file at `path` was read, or nothing if that file was not
  /// read.
  [[nodiscard]] std::optional<std::string> name_of(const std::filesystem::path& path) const;

  /// Returns the states of the files, by name, from before they were opened for the first time. A
  /// file whose state differs now was changed after that moment, perhaps while it was read.
  [[nodiscard]] const std::map<std::string, FileState>& states() const { return states_; }

  void note(const std::string& name, const FileState& state) {
    name_of_.emplace(state.identity, name);
    states_.emplace(name, state);
  }

 private:
  std::map<FileIdentity, std::string> name_of_;
  std::map<std::string, FileState> states_;
  ReadFiles* former_;
};

}  // namespace microtrace
