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
#include <list>
#include <string>
#include <sys/types.h>

namespace microtrace::http {

class Connection;

class Server {
 public:
  /// Binds to 127.0.0.1. Throws boost::system::system_error.
  explicit Server(const MicrotraceHttpHost& host);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

  /// Serves until the host's goes_on() returns 0.
  void run();

  [[nodiscard]] const MicrotraceHttpHost& host() const { return host_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] const std::string& allowed_host() const { return allowed_host_; }
  [[nodiscard]] boost::asio::io_context& context() { return context_; }

  /// The connections that wait for a request or receive one, the one that began first in front.
  using Quiet = std::list<Connection*>;
  [[nodiscard]] Quiet& quiet() { return quiet_; }

  void count_connections(int change) { connections_ += change; }

 private:
  static constexpr int kMostConnections = 64;

  void accept();
  /// Accepts again after a moment.
  void accept_later();
  /// Returns true if another connection is allowed. At the limit, closes the one that has been
  /// quiet for the longest time.
  [[nodiscard]] bool make_room();
  void tick();

  MicrotraceHttpHost host_;
  std::string token_, allowed_host_;
  // Used by the thread of run() only, also by connections that end with the context.
  int connections_ = 0;
  Quiet quiet_;
  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::acceptor acceptor_;
  pid_t process_;  ///< that listens
  boost::asio::steady_timer timer_, retry_;
};

}  // namespace microtrace::http
