#include "io/confined_reads.hpp"

#include "base/system/descriptor.hpp"
#include "base/system/error_text.hpp"
#include "base/text/printable.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#if __has_include(<linux/openat2.h>)
#include <linux/openat2.h>
#endif

namespace microtrace::io {
namespace {

/// The innermost ConfinedReads of this thread, or null.
thread_local const ConfinedReads* confinement = nullptr;

bool are_same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Returns true if the path leads to the opened file from one of the folders, which needs no access
/// to the folders above them. Links may not lead out of the folder. Needs Linux 5.6.
bool is_beneath([[maybe_unused]] const std::vector<std::filesystem::path>& folders,
                [[maybe_unused]] const std::filesystem::path& path,
                [[maybe_unused]] const struct stat& opened) {
#ifdef RESOLVE_BENEATH
  return std::ranges::any_of(folders, [&](const std::filesystem::path& folder) {
    const std::filesystem::path relative = path.lexically_relative(folder);
    if (relative.empty()) return false;
    const Descriptor base(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    open_how how{};
    how.flags = O_PATH | O_CLOEXEC;
    how.resolve = RESOLVE_BENEATH;
    const Descriptor again(static_cast<int>(
        ::syscall(SYS_openat2, base.number(), relative.c_str(), &how, sizeof how)));
    struct stat found {};
    return ::fstat(again.number(), &found) == 0 && are_same(found, opened);
  });
#else
  return false;
#endif
}

}  // namespace

bool lies_within(const std::vector<std::filesystem::path>& folders,
                 const std::filesystem::path& path) {
  std::error_code code;
  const std::filesystem::path place = std::filesystem::weakly_canonical(path, code);
  if (code) return false;
  return std::ranges::any_of(folders, [&](const std::filesystem::path& allowed) {
    const std::filesystem::path folder = std::filesystem::canonical(allowed, code);
    if (code) return false;
    return std::mismatch(folder.begin(), folder.end(), place.begin(), place.end()).first ==
           folder.end();
  });
}

ConfinedReads::ConfinedReads(const std::filesystem::path& own,
                             std::vector<std::filesystem::path> allowed)
    : folders_(std::move(allowed)), former_(confinement) {
  folders_.push_back(own.empty() ? "." : own);
  confinement = this;
}

ConfinedReads::~ConfinedReads() {
  confinement = former_;
}

void ConfinedReads::require(const std::filesystem::path& path, std::optional<int> descriptor) {
  if (confinement == nullptr) return;
  std::error_code code;
  const std::filesystem::path real = std::filesystem::canonical(path, code);
  if (code && !descriptor) return;  // the attempt to open the file will report the reason
  struct stat opened {};
  struct stat checked {};
  const bool is_known = descriptor && ::fstat(*descriptor, &opened) == 0;
  if (code && !(is_known && is_beneath(confinement->folders_, path, opened)))
    throw Error(ErrorKind::io, path.string(),
                "can't be compared with the scene's folder: " + error_text(code.value()));
  if (code) return;
  if (!lies_within(confinement->folders_, real)) {
    throw Error(ErrorKind::invalid_scene, path.string(),
                "is a link out of the scene's folder, to " + in_quotes(real.string()) +
                    "; allow the folder of that file (--allow-path)");
  }
  if (!descriptor) return;
  if (!is_known || ::stat(real.c_str(), &checked) != 0 || !are_same(checked, opened))
    throw Error(ErrorKind::io, path.string(), "was replaced while it was opened; try again");
}

}  // namespace microtrace::io
