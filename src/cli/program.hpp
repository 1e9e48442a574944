#pragma once

namespace microtrace::cli {

/// The program microtrace, with the arguments of main(). Returns its exit code. Installs signal
/// handlers that end the process.
int run_program(int argc, char** argv);

}  // namespace microtrace::cli
