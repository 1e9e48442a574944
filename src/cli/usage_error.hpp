#pragma once
/// What the program says of a command line that it can't follow.

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace microtrace::cli {

/// Throws CLI::ValidationError if an option or SCENE has an empty text as its value.
void refuse_empty_values(const CLI::App& app);

/// Prints help and version, which CLI11 throws too, to standard output and returns 0; prints any
/// other error in the program's format to standard error, unknown options first, and returns the
/// exit code of usage errors.
[[nodiscard]] int report(const CLI::App& app, const CLI::ParseError& error);

}  // namespace microtrace::cli
