#include "cli/temporary_folder.hpp"

#include "base/system/error_text.hpp"
#include "io/output/unfinished_files.hpp"

#include <microtrace/error.hpp>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

namespace microtrace::cli {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  const char* const chosen = std::getenv("TMPDIR");
  const fs::path parent = chosen != nullptr && *chosen != '\0' ? chosen : "/tmp";
  std::string pattern = (parent / "microtrace-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr)
    throw Error(ErrorKind::io, pattern,
                "can't be created: " + error_text(errno) +
                    "; set TMPDIR to a folder that may be written to");
  path_ = pattern;
  slot_ = io::note_unfinished_file(path_.c_str());
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  io::forget_unfinished_file(slot_);
}

}  // namespace microtrace::cli
