#include "cli/program.hpp"

/// The program, for the command of the package: a second executable would double its size.
extern "C" [[gnu::visibility("default")]] int microtrace_program(int argc, char** argv) {
  return microtrace::cli::run_program(argc, argv);
}
