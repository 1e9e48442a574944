#pragma once
/// Records which files were read, so that none of them is overwritten.

#include <microtrace/export.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace microtrace {

/// A file's device and inode: the same for all its names and links.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;

/// The identity of the regular file to which the name leads; "-" is standard output. Nothing if
/// there is none, or if it is another kind of file.
[[nodiscard]] MICROTRACE_EXPORT std::optional<FileIdentity> identity_of(
    const std::filesystem::path& path);

/// True if both names lead to the same file, even one that does not exist yet.
[[nodiscard]] MICROTRACE_EXPORT bool are_same_target(const std::filesystem::path& a,
                                                     const std::filesystem::path& b);

/// During its lifetime, records all regular files, including standard input, that the library reads
/// on this thread, and those that scenes name. If there are several objects, the last one counts.
class MICROTRACE_EXPORT ReadFiles {
 public:
  ReadFiles();
  ~ReadFiles();
  ReadFiles(const ReadFiles&) = delete;
  ReadFiles& operator=(const ReadFiles&) = delete;

  /// The name under which the file was read to which `path` leads; nothing if it was not read.
  [[nodiscard]] std::optional<std::string> name_of(const std::filesystem::path& path) const;

  void note(const FileIdentity& file, const std::string& name) { names_.emplace(file, name); }

 private:
  std::map<FileIdentity, std::string> names_;
  ReadFiles* former_;
};

}  // namespace microtrace
