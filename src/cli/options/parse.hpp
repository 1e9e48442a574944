#pragma once
#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <optional>
#include <string>
#include <vector>

namespace microtrace::cli {

struct Parsed {
  Arguments arguments;
  std::optional<std::string> output{};  ///< if present, --help or --version asks for this text
  std::optional<int> exit_code{};       ///< if present, the program should end with it
};

/// Parses the arguments of a command. Prints usage errors to standard error; exit_code is then
/// present.
[[nodiscard]] Parsed parse_arguments(Command command, int argc, char** argv);

/// Parses the words that follow a command. Throws Error (usage), also for --help and --version.
[[nodiscard]] Arguments parse_words(Command command, std::vector<std::string> words);

}  // namespace microtrace::cli
