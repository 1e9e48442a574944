#pragma once
#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <optional>

namespace microtrace::cli {

struct Parsed {
  Arguments arguments;
  std::optional<int> exit_code{};  ///< if present, the program should end with it
};

/// Parses the arguments of a command. Prints the output of --help and --version to standard output
/// and usage errors to standard error; in these cases exit_code is present.
[[nodiscard]] Parsed parse_arguments(Command command, int argc, char** argv);

}  // namespace microtrace::cli
