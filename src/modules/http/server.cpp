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
    // Errors, such as too many open files, pass.
    if (!error && make_room()) std::make_shared<Connection>(*this, std::move(socket))->read();
    accept();
  });
}

bool Server::make_room() {
  if (connections_ < kMostConnections) return true;
  if (quiet_.empty()) return false;  // all wait for responses
  quiet_.front()->close();
  return true;
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
