#pragma once
/// The table of command-line options, one row per option. Parsing, --help, the manual page,
/// completion, suggestions for mistyped names and the identity of checkpoints all use this table.
///
/// To add an option, add a row to one of src/cli/options/*_options.cpp, and the code that uses the
/// option's value. The value is stored in Arguments, directly or in a member that is an options
/// struct of the library. Tests report options that docs/command-line.md or the manual page doesn't
/// describe. `tests/cli/manual_test.py PROGRAM SOURCE_FOLDER --update` adds them to the manual
/// page.

#include "cli/options/option_value.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::cli {

struct Arguments;

/// The commands that take an option. All but `render` are selected by their name as the first
/// argument.
enum class Command { render, merge, dataset, verify, explain, compare, view };

inline constexpr std::array kCommands{Command::render, Command::merge,   Command::dataset,
                                      Command::verify, Command::explain, Command::compare,
                                      Command::view};

/// The effect of an option on the samples of Monte Carlo integrators. Samples of several runs can
/// be combined only if all options that change samples have the same values in these runs.
enum class Samples { undecided, change, keep };

/// Values that shells offer for completion, in addition to Option::words.
enum class Completion { none, files, folders };

struct Option {
  /// Comma-separated names, short ones first: "-o,--output". The name of a positional argument has
  /// no dashes.
  std::string_view names;
  std::string_view metavar{};  ///< placeholder of the value, such as "FILE"; empty for flags
  std::string_view help;
  std::string_view default_value{};  ///< a value or its description; empty if there is none
  std::string_view implied_value{};  ///< used if no value is given; empty: a value is required
  Samples samples = Samples::undecided;
  Completion completion = Completion::none;
  /// Returns the named values; null if there are none.
  std::vector<std::string> (*words)() = nullptr;
  bool takes_list = false;  ///< true if the value is a list of `words`, separated by commas
  bool is_required = false;
  bool is_repeatable = false;
  std::string_view needs{};     ///< an option that must also be given
  std::string_view excludes{};  ///< options that must not be given, space-separated
  /// Stores the value or, for a flag, that the flag is given. Throws Error (usage). Called in the
  /// order of the table. Null for --help and --version, which end the program.
  void (*set)(Arguments&, const OptionValue&) = nullptr;

  /// Returns the first long name, such as "--output", or the name of the positional argument.
  [[nodiscard]] std::string_view name() const;
  [[nodiscard]] std::vector<std::string_view> all_names() const;
  /// Returns true if the option takes no value.
  [[nodiscard]] bool is_switch() const { return metavar.empty(); }
  /// Returns true if the option may be given without a value.
  [[nodiscard]] bool is_flag() const { return is_switch() || !implied_value.empty(); }
  [[nodiscard]] bool is_positional() const { return !names.starts_with('-'); }
};

/// Options under one heading of --help.
struct OptionGroup {
  std::string_view title;
  std::span<const Option> options;
};

/// Returns all options of a command, in the order of --help.
[[nodiscard]] std::vector<OptionGroup> option_groups(Command command);

// The tables of options, one for each heading of --help.
[[nodiscard]] std::span<const Option> picture_options();
[[nodiscard]] std::span<const Option> camera_options();
[[nodiscard]] std::span<const Option> light_options();
[[nodiscard]] std::span<const Option> display_options(Command command);
[[nodiscard]] std::span<const Option> sampling_options();
[[nodiscard]] std::span<const Option> asset_options();
[[nodiscard]] std::span<const Option> checkpoint_options();
[[nodiscard]] std::span<const Option> running_options();
[[nodiscard]] std::span<const Option> report_options();
[[nodiscard]] std::span<const Option> common_options();
[[nodiscard]] std::span<const Option> merge_options();
[[nodiscard]] std::span<const Option> dataset_options();
[[nodiscard]] std::span<const Option> verify_options();
[[nodiscard]] std::span<const Option> explain_options();
[[nodiscard]] std::span<const Option> compare_options();
[[nodiscard]] std::span<const Option> view_options();

/// Returns true if every row has names, a help text and a stated effect on samples.
constexpr bool is_complete(std::span<const Option> options) {
  return std::ranges::all_of(options, [](const Option& option) {
    return !option.names.empty() && !option.help.empty() && option.samples != Samples::undecided;
  });
}

}  // namespace microtrace::cli
