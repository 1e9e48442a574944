#include "cli/program.hpp"

/// Runs the program for the package's command. A separate executable would double the package's
/// size.
extern "C" [[gnu::visibility("default")]] int microtrace_program(int argc, char** argv) {
  return microtrace::cli::run_program(argc, argv);
}
