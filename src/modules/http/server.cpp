#include "modules/http/server.hpp"

#include "modules/http/connection.hpp"

#include <chrono>
#include <fcntl.h>
#include <memory>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

namespace microtrace::http {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

/// Keeps a browser that the program starts from inheriting the socket, and with it the port.
template <class Socket>
void close_on_exec(Socket& socket) {
  static_cast<void>(::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC));
}

}  // namespace

Server::Server(const MicrotraceHttpHost& host)
    : host_(host),
      token_(host.token),
      allowed_host_(host.allowed_host),
      acceptor_(context_, tcp::endpoint(asio::ip::address_v4::loopback(), host.port)),
      process_(::getpid()),
      timer_(context_),
      retry_(context_) {
  close_on_exec(acceptor_);
  accept();
}

Server::~Server() {
  // Processes that were forked meanwhile have the socket, too, and would keep the port.
  if (::getpid() == process_) ::shutdown(acceptor_.native_handle(), SHUT_RDWR);
}

void Server::run() {
  context_.restart();
  tick();  // may stop the context
  context_.run();
}

void Server::accept() {
  acceptor_.async_accept([this](const boost::system::error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) return accept_later();
    close_on_exec(socket);
    if (make_room()) std::make_shared<Connection>(*this, std::move(socket))->read();
    accept();
  });
}

void Server::accept_later() {
  // Errors, such as too many open files, pass, the sooner the fewer connections there are.
  if (!quiet_.empty()) quiet_.front()->close();
  retry_.expires_after(std::chrono::milliseconds(100));
  retry_.async_wait([this](const boost::system::error_code& error) {
    if (!error) accept();
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
