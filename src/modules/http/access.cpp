#include "modules/http/access.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace microtrace::http {
namespace {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

bool are_equal(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char other = b.empty() ? '\0' : b[i % b.size()];
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(other);
  }
  return difference == 0;
}

std::optional<HostName> split_host(std::string_view text) {
  HostName host{.name = lower_case(text), .port = {}};
  // The colons of an IPv6 address are within brackets.
  const std::size_t colon = text.rfind(':');
  if (colon != std::string_view::npos && text.find(']', colon) == std::string_view::npos) {
    host.name.resize(colon);
    host.port = text.substr(colon + 1);
    if (!is_port(host.port)) return std::nullopt;
  }
  if (host.name.empty()) return std::nullopt;
  return host;
}

bool is_own_host(std::string_view host, std::string_view allowed) {
  const std::optional<HostName> given = split_host(host), other = split_host(allowed);
  if (!given) return false;
  constexpr std::array<std::string_view, 3> kLoopback{"localhost", "127.0.0.1", "[::1]"};
  return std::ranges::find(kLoopback, given->name) != kLoopback.end() ||
         (other && given->name == other->name);
}

bool is_own_origin(std::string_view origin, std::string_view host, std::string_view allowed) {
  struct Scheme {
    std::string_view start, port;
  };
  for (const auto& [start, default_port] : {Scheme{"http://", "80"}, Scheme{"https://", "443"}}) {
    if (!origin.starts_with(start)) continue;
    const std::string_view rest = origin.substr(start.size());
    if (lower_case(rest) == lower_case(host)) return true;
    const std::optional<HostName> given = split_host(rest), other = split_host(allowed);
    const auto port_of = [port = default_port](const HostName& name) {
      return name.port.empty() ? port : std::string_view(name.port);
    };
    return given && other && given->name == other->name && port_of(*given) == port_of(*other);
  }
  return false;
}

}  // namespace microtrace::http
