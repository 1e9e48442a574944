#pragma once
#include <string>

#include <CLI/App.hpp>

namespace microtrace::cli {

/// Makes --help fit a terminal of 100 columns.
void set_help_format(CLI::App& app);

/// The kind of an option's value alone, without what the program checks of it.
[[nodiscard]] std::string value_name(const CLI::Option& option);

}  // namespace microtrace::cli
