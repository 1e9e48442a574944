#include "cli/pictures/display_server.hpp"

#include "base/text/printable.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <netdb.h>
#include <string_view>
#include <sys/socket.h>
#include <type_traits>
#include <unistd.h>
#include <utility>

namespace microtrace::cli {
namespace {

// Each packet begins with its size and an operation. Numbers are little-endian, texts end with 0
// (tev, src/Ipc.cpp).
enum class Operation : std::uint8_t { create_image = 4, update_image = 6 };

template <class T>
void append(std::string& packet, T value) {
  static_assert(std::is_trivially_copyable_v<T> && std::endian::native == std::endian::little);
  packet.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string start_packet(Operation operation, bool grabs_focus, const std::string& name) {
  std::string packet;
  append(packet, std::uint32_t{0});  // the size
  append(packet, operation);
  append(packet, grabs_focus);
  return packet.append(name.c_str(), name.size() + 1);
}

std::string_view letters_of(const Film& film) {
  return film.has_alpha() ? "RGBA" : "RGB";
}

void append_names(std::string& packet, std::string_view channels) {
  for (const char channel : channels) packet.append({channel, '\0'});
}

/// Returns a socket that is connected, or -1 with errno.
int connected_socket(const addrinfo* addresses) {
  constexpr timeval kPatience{.tv_sec = 5, .tv_usec = 0};
  for (const addrinfo* a = addresses; a != nullptr; a = a->ai_next) {
    const int socket = ::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    if (socket < 0) continue;
    // Limits the times of connecting and of sending.
    ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
    if (::connect(socket, a->ai_addr, a->ai_addrlen) == 0) return socket;
    const int error = errno == EINPROGRESS ? ETIMEDOUT : errno;
    ::close(socket);
    errno = error;
  }
  return -1;
}

}  // namespace

DisplayServer::DisplayServer(const NetworkAddress& address, bool is_quiet) : is_quiet_(is_quiet) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* addresses = nullptr;
  const int failure =
      ::getaddrinfo(address.host.c_str(), address.port.c_str(), &wanted, &addresses);
  const char* reason = failure == 0 ? nullptr : ::gai_strerror(failure);
  if (failure == 0) {
    socket_ = connected_socket(addresses);
    if (socket_ < 0) reason = std::strerror(errno);
    ::freeaddrinfo(addresses);
  }
  if (reason != nullptr) {
    throw Error(ErrorKind::io, "--display-server",
                printable(address.host) + " port " + address.port + ": " + reason +
                    "; start tev first, or a tunnel to it");
  }
}

DisplayServer::~DisplayServer() {
  if (socket_ >= 0) ::close(socket_);
}

void DisplayServer::open(const Film& film) {
  std::string packet = start_packet(Operation::create_image, true, name_);
  append(packet, static_cast<std::int32_t>(film.whole.width));
  append(packet, static_cast<std::int32_t>(film.whole.height));
  const std::string_view channels = letters_of(film);
  append(packet, static_cast<std::int32_t>(channels.size()));
  append_names(packet, channels);
  send(std::move(packet));
}

void DisplayServer::show(const std::string& name, const Film& film) {
  constexpr std::uint32_t kRows = 64;  // of one packet
  const auto start = Clock::now();
  if (std::exchange(name_, name) != name) open(film);
  const std::string_view channels = letters_of(film);
  const auto [width, height] = film.size();
  for (std::uint32_t y = 0; y < height; y += kRows) {
    const std::uint32_t rows = std::min(kRows, height - y);
    std::string packet = start_packet(Operation::update_image, false, name_);
    append(packet, static_cast<std::int32_t>(channels.size()));
    append_names(packet, channels);
    for (const std::uint32_t number : {film.x0, film.y0 + y, width, rows})
      append(packet, static_cast<std::int32_t>(number));
    // The first value of each channel, and the distance to the next one.
    for (std::size_t c = 0; c < channels.size(); ++c) append(packet, std::int64_t(c));
    for (std::size_t c = 0; c < channels.size(); ++c) append(packet, std::int64_t(channels.size()));
    packet.reserve(packet.size() + std::size_t{4} * channels.size() * width * rows);
    for (std::uint32_t row = y; row < y + rows; ++row) {
      for (std::uint32_t x = 0; x < width; ++x) {
        append(packet, film.row(row)[x]);
        if (film.has_alpha()) append(packet, film.alpha_row(row)[x]);
      }
    }
    send(std::move(packet));
  }
  shown_ = Clock::now();
  cost_ = shown_ - start;
}

bool DisplayServer::is_due() const {
  return socket_ >= 0 && Clock::now() - shown_ > 20 * cost_;
}

void DisplayServer::send(std::string packet) {
  const auto size = static_cast<std::uint32_t>(packet.size());
  std::memcpy(packet.data(), &size, sizeof size);
  for (std::size_t sent = 0; socket_ >= 0 && sent < packet.size();) {
    const ssize_t more = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    if (more > 0) {
      sent += static_cast<std::size_t>(more);
    } else if (errno != EINTR) {
      if (!is_quiet_)
        std::fprintf(stderr, "warning: --display-server: %s; nothing more is shown\n",
                     std::strerror(errno == EAGAIN ? ETIMEDOUT : errno));
      ::close(socket_);
      socket_ = -1;
    }
  }
}

}  // namespace microtrace::cli
