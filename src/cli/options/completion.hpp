#pragma once
/// `microtrace completion SHELL` prints a script that lets the shell complete microtrace's command
/// line.

#include <string>

namespace microtrace::cli {

/// Returns true if the first argument is "completion".
[[nodiscard]] bool is_completion(int argc, char** argv);

/// Returns the script for the shell that the arguments name, or the usage for --help. Throws Error
/// (usage).
[[nodiscard]] std::string completion_text(int argc, char** argv);

}  // namespace microtrace::cli
