#pragma once
#include <string>

namespace microtrace::cli {

/// Asks the desktop to open an address, if there is one. Failures are ignored: the address is also
/// printed.
void open_browser(const std::string& address);

}  // namespace microtrace::cli
