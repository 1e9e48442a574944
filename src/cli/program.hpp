#pragma once

namespace microtrace::cli {

/// Runs the program microtrace with the arguments of main() and returns its exit code. Installs
/// signal handlers that end the process.
int run_program(int argc, char** argv);

}  // namespace microtrace::cli
