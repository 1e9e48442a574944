#pragma once
#include "cli/options/option.hpp"

#include <string>
#include <string_view>

namespace microtrace::cli {

/// Returns "render" or the argument that selects the command, such as "merge".
[[nodiscard]] std::string_view name_of(Command command);

/// Returns "microtrace" or "microtrace merge".
[[nodiscard]] std::string program_name(Command command);

/// Returns the text of --help, for a terminal with 100 columns.
[[nodiscard]] std::string help_text(Command command);

}  // namespace microtrace::cli
