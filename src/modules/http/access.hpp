#pragma once
/// Decides which requests are accepted. The server listens only on the loopback interface, but
/// every user of the machine can reach it there, and so can every page in the user's browser.

#include <optional>
#include <string>
#include <string_view>

namespace microtrace::http {

/// Compares in a time that doesn't depend on the position of the first difference.
[[nodiscard]] bool are_equal(std::string_view a, std::string_view b);

/// A host name in lower case, and the digits of a port, which may be empty.
struct HostName {
  std::string name, port;
};

/// Splits NAME or NAME:PORT, where an IPv6 address is in brackets. Returns nothing for other text.
[[nodiscard]] std::optional<HostName> split_host(std::string_view text);

/// Returns true if the Host header names the loopback interface or the host of `allowed`, which may
/// be empty, with any port or none. A page of another site that directs its own name to 127.0.0.1
/// ("DNS rebinding") sends its own name.
[[nodiscard]] bool is_own_host(std::string_view host, std::string_view allowed);

/// Returns true if the Origin header belongs to the page that this server sent: it has the host and
/// port of `host`, the value of the Host header, or those of `allowed`. The latter is the origin of
/// a proxy that replaces the Host header; without a port, it has the default port of the origin's
/// scheme, so pages at other ports of the same host are refused. Browsers add the header when a
/// page of any origin sends data.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host,
                                 std::string_view allowed);

}  // namespace microtrace::http
