#include "cli/temporary_folder.hpp"

#include "io/unfinished_files.hpp"

#include <microtrace/error.hpp>

#include <cstdlib>
#include <string>
#include <system_error>

namespace microtrace::cli {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  std::string pattern = (fs::temp_directory_path(error) / "microtrace-XXXXXX").string();
  if (error || ::mkdtemp(pattern.data()) == nullptr)
    throw Error(ErrorKind::io, pattern, "can't be created; set TMPDIR to a folder with space");
  path_ = pattern;
  slot_ = io::note_unfinished_file(path_.c_str());
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  io::forget_unfinished_file(slot_);
}

}  // namespace microtrace::cli
