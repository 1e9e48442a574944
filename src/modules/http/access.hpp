#pragma once
/// Decides which requests are accepted. The server listens only on the loopback interface, but
/// every user of the machine can reach it there, and so can every page in the user's browser.

#include <string_view>

namespace microtrace::http {

/// Compares in a time that doesn't depend on the position of the first difference.
[[nodiscard]] bool are_equal(std::string_view a, std::string_view b);

/// Returns true if the Host header names the loopback interface or `allowed`, with or without a
/// port. A page of another site that directs its own name to 127.0.0.1 ("DNS rebinding") sends its
/// own name.
[[nodiscard]] bool is_own_host(std::string_view host, std::string_view allowed);

/// Returns true if the Origin header belongs to the page that this server sent under `host`, the
/// value of the Host header. Browsers add the header when a page of any origin sends data.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host);

}  // namespace microtrace::http
