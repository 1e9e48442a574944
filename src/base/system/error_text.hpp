#pragma once
#include <string>

namespace microtrace {

/// Returns the system's description of an errno value, in English whatever the host's locale is.
[[nodiscard]] std::string error_text(int error);

}  // namespace microtrace
