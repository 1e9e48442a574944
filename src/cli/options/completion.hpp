#pragma once
/// `microtrace completion SHELL` prints a script that lets the shell complete microtrace's command
/// line.

#include <optional>
#include <string>
#include <string_view>

namespace microtrace::cli {

/// Returns true if the first argument is "completion".
[[nodiscard]] bool is_completion(int argc, char** argv);

/// Prints the script to standard output; returns the exit code.
[[nodiscard]] int print_completion(int argc, char** argv);

/// Returns the script for bash, zsh or fish; nothing for another shell.
[[nodiscard]] std::optional<std::string> completion_script(std::string_view shell);

}  // namespace microtrace::cli
