#pragma once
#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <optional>

namespace microtrace::cli {

struct Parsed {
  Arguments arguments;
  std::optional<int> exit_code{};  ///< if present, nothing is left to do
};

/// Reads the command line of a command. Prints --help and --version to standard output and usage
/// errors to standard error; the exit code is then present.
[[nodiscard]] Parsed parse_arguments(Command command, int argc, char** argv);

}  // namespace microtrace::cli
