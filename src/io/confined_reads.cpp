#include "io/confined_reads.hpp"

#include "base/text/printable.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <utility>

namespace microtrace::io {
namespace {

/// The innermost ConfinedReads of this thread, or null.
thread_local const ConfinedReads* confinement = nullptr;

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
  if (!code && !lies_within(confinement->folders_, real)) {
    throw Error(ErrorKind::invalid_scene, path.string(),
                "is a link out of the scene's folder, to " + in_quotes(real.string()) +
                    "; allow the folder of that file (--allow-path)");
  }
  if (!descriptor) return;
  struct stat opened {};
  struct stat checked {};
  const bool is_same = !code && ::fstat(*descriptor, &opened) == 0 &&
                       ::stat(real.c_str(), &checked) == 0 && opened.st_dev == checked.st_dev &&
                       opened.st_ino == checked.st_ino;
  if (!is_same)
    throw Error(ErrorKind::io, path.string(), "was replaced while it was opened; try again");
}

}  // namespace microtrace::io
