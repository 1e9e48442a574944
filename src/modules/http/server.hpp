#pragma once
/// An HTTP/1.1 server on the loopback interface, with limits on the sizes of requests, on the
/// number of connections and on times.

#include "io/http/http_abi.hpp"

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstddef>
#include <cstdint>
#include <string>

namespace microtrace::http {

class Server {
 public:
  /// Binds to 127.0.0.1. Throws boost::system::system_error.
  explicit Server(const MicrotraceHttpHost& host);

  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

  /// Serves until the host's goes_on() returns 0.
  void run();

  [[nodiscard]] const MicrotraceHttpHost& host() const { return host_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] const std::string& allowed_host() const { return allowed_host_; }
  [[nodiscard]] boost::asio::io_context& context() { return context_; }

  void count_connections(int change) { connections_ += change; }

 private:
  static constexpr int kMostConnections = 64;

  void accept();
  void tick();

  MicrotraceHttpHost host_;
  std::string token_, allowed_host_;
  int connections_ = 0;  // used by the thread of run() only
  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer timer_;
};

}  // namespace microtrace::http
