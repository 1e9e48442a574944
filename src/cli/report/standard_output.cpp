#include "cli/report/standard_output.hpp"

#include "io/output/atomic_file.hpp"

namespace microtrace::cli {

void write_standard_output(const std::string& text) {
  io::AtomicFile output("-");
  output.write(text);
  output.commit();
}

}  // namespace microtrace::cli
