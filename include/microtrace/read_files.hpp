#pragma once
/// Records which files were read, so that a program can avoid overwriting them.

#include <microtrace/export.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace microtrace {

/// A file's device and inode numbers, which are the same for all names and links of the file.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;

/// Returns the identity of the regular file to which the path leads; "-" means standard output.
/// Returns nothing if there is no file or if it is not a regular file.
[[nodiscard]] MICROTRACE_EXPORT std::optional<FileIdentity> identity_of(
    const std::filesystem::path& path);

/// Returns true if both paths lead to the same file, even if the file does not exist yet.
[[nodiscard]] MICROTRACE_EXPORT bool are_same_target(const std::filesystem::path& a,
                                                     const std::filesystem::path& b);

/// During its lifetime, records all regular files that the library reads on this thread, including
/// standard input, and all files that scenes name. If several objects exist on a thread, only the
/// most recent one records.
class MICROTRACE_EXPORT ReadFiles {
 public:
  ReadFiles();
  ~ReadFiles();
  ReadFiles(const ReadFiles&) = delete;
  ReadFiles& operator=(const ReadFiles&) = delete;

  /// Returns the name under which the file at `path` was read, or nothing if that file was not
  /// read.
  [[nodiscard]] std::optional<std::string> name_of(const std::filesystem::path& path) const;

  /// Returns all names under which files were read, in ascending order.
  [[nodiscard]] const std::set<std::string>& names() const { return names_; }

  void note(const FileIdentity& file, const std::string& name) {
    name_of_.emplace(file, name);
    names_.insert(name);
  }

 private:
  std::map<FileIdentity, std::string> name_of_;
  std::set<std::string> names_;
  ReadFiles* former_;
};

}  // namespace microtrace
