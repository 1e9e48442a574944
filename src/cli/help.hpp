#pragma once
#include <CLI/App.hpp>

namespace microtrace::cli {

/// Makes --help fit a terminal of 100 columns.
void set_help_format(CLI::App& app);

}  // namespace microtrace::cli
