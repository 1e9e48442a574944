#include "io/output/file_access.hpp"

#include <sys/xattr.h>
#include <unistd.h>
#include <vector>

namespace microtrace::io {
namespace {

constexpr const char* kAccessList = "system.posix_acl_access";

/// Copies the access control list, or removes the one that the file inherited from its folder.
/// Returns false if the list can't be copied.
bool copy_list(const std::filesystem::path& from, int descriptor) {
  const ssize_t size = ::getxattr(from.c_str(), kAccessList, nullptr, 0);
  if (size <= 0) {
    static_cast<void>(::fremovexattr(descriptor, kAccessList));
    return true;
  }
  std::vector<char> list(static_cast<std::size_t>(size));
  const ssize_t read = ::getxattr(from.c_str(), kAccessList, list.data(), list.size());
  return read == size && ::fsetxattr(descriptor, kAccessList, list.data(), list.size(), 0) == 0;
}

}  // namespace

void copy_access(const std::filesystem::path& from, const struct stat& status, int descriptor) {
  struct stat own {};
  if (::fstat(descriptor, &own) != 0) return;
  mode_t mode = status.st_mode & 0777;
  const bool has_group = own.st_gid == status.st_gid ||
                         ::fchown(descriptor, static_cast<uid_t>(-1), status.st_gid) == 0;
  // Another group's members were among the others, and the group's own members are now.
  if (!has_group) mode = (mode & 0700) | (mode & (mode >> 3) & 0007) * 011;
  // The list comes before the permissions, whose group part is the mask of a list.
  if (!copy_list(from, descriptor)) mode &= 0700;
  static_cast<void>(::fchmod(descriptor, mode));
  // Only root can give files away. GCC warns of an unused result in spite of static_cast<void>.
  if (own.st_uid != status.st_uid &&
      ::fchown(descriptor, status.st_uid, static_cast<gid_t>(-1)) != 0)
    return;
}

bool may_replace(const std::filesystem::path& folder, const struct stat& file) {
  struct stat place {};
  if (::stat(folder.c_str(), &place) != 0 || (place.st_mode & S_ISVTX) == 0) return true;
  const uid_t self = ::geteuid();
  return self == 0 || self == file.st_uid || self == place.st_uid;
}

}  // namespace microtrace::io
