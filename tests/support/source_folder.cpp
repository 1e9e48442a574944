#include "support/source_folder.hpp"

namespace microtrace::tests {

std::filesystem::path source_folder() {
  return MICROTRACE_SOURCE_DIR;
}

}  // namespace microtrace::tests
