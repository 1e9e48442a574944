#pragma once
/// Which files were read, so that none of them is written over.

#include <microtrace/export.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace microtrace {

/// A file by its device and inode: the same under all its names and links.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;

/// That of the regular file to which the name leads; "-" is standard output. Nothing where there is
/// none, or another kind of file.
[[nodiscard]] MICROTRACE_EXPORT std::optional<FileIdentity> identity_of(
    const std::filesystem::path& path);

/// Whether writing to both names would write one file, be it there already or not.
[[nodiscard]] MICROTRACE_EXPORT bool are_same_target(const std::filesystem::path& a,
                                                     const std::filesystem::path& b);

/// While it lives, notes all regular files, standard input among them, that the library reads on
/// this thread, and those that its scenes name: at the one place where it reads, so that none can
/// be forgotten. The last one made counts.
class MICROTRACE_EXPORT ReadFiles {
 public:
  ReadFiles();
  ~ReadFiles();
  ReadFiles(const ReadFiles&) = delete;
  ReadFiles& operator=(const ReadFiles&) = delete;

  /// The name under which the file to which `path` leads was read; nothing if it was not.
  [[nodiscard]] std::optional<std::string> name_of(const std::filesystem::path& path) const;

  void note(const FileIdentity& file, const std::string& name) { names_.emplace(file, name); }

 private:
  std::map<FileIdentity, std::string> names_;
  ReadFiles* former_;
};

}  // namespace microtrace
