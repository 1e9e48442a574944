#include "modules/http/server.hpp"

#include "modules/http/connection.hpp"

#include <chrono>
#include <memory>
#include <utility>

namespace microtrace::http {

namespace asio = boost::asio;
using asio::ip::tcp;

Server::Server(const MicrotraceHttpHost& host)
    : host_(host),
      token_(host.token),
      allowed_host_(host.allowed_host),
      acceptor_(context_, tcp::endpoint(asio::ip::address_v4::loopback(), host.port)),
      timer_(context_) {
  accept();
}

void Server::run() {
  context_.restart();
  tick();  // may stop the context
  context_.run();
}

void Server::accept() {
  acceptor_.async_accept([this](const boost::system::error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    // Connections beyond the limit are closed at once. Errors, such as too many open files, pass.
    if (!error && connections_ < kMostConnections)
      std::make_shared<Connection>(*this, std::move(socket))->read();
    accept();
  });
}

void Server::tick() {
  if (host_.goes_on(host_.context) == 0) {
    context_.stop();
    return;
  }
  timer_.expires_after(std::chrono::milliseconds(100));
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) tick();
  });
}

}  // namespace microtrace::http
