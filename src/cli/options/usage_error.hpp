#pragma once
#include "cli/options/option.hpp"

#include <optional>
#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace microtrace::cli {

/// Returns the message for a command line that CLI11 rejects. It reports an unknown option, with
/// the most similar known name, before any other error.
[[nodiscard]] std::string message_of(Command command, const CLI::App& app,
                                     const CLI::ParseError& error);

/// Returns the message for a first word that is neither an option nor a file, but similar to the
/// name of a command.
[[nodiscard]] std::optional<std::string> complaint_about_command(const std::string& word);

/// Prints the message to standard error; returns the exit code of usage errors.
[[nodiscard]] int report_usage_error(Command command, const std::string& message);

}  // namespace microtrace::cli
