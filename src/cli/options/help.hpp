#pragma once
#include "cli/options/option.hpp"

#include <string>

namespace microtrace::cli {

/// Returns "microtrace" or "microtrace merge".
[[nodiscard]] std::string program_name(Command command);

/// Returns the text of --help, for a terminal with 100 columns.
[[nodiscard]] std::string help_text(Command command);

}  // namespace microtrace::cli
