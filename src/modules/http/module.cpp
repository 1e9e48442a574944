/// Serves HTTP by Boost.Beast, behind the C interface of io/http/http_abi.hpp. The program loads
/// this module for the command view.

#include "modules/http/connection.hpp"
#include "modules/http/server.hpp"

#include <boost/asio/post.hpp>
#include <exception>
#include <memory>
#include <string>
#include <utility>

using microtrace::http::Connection;
using microtrace::http::make_response;
using microtrace::http::Server;

struct MicrotraceHttpServer {
  explicit MicrotraceHttpServer(const MicrotraceHttpHost& host) : server(host) {}
  Server server;
};

namespace {

MicrotraceHttpServer* open(const MicrotraceHttpHost* host) {
  try {
    return new MicrotraceHttpServer(*host);
  } catch (const boost::system::system_error& error) {
    const bool is_of_system = error.code().category() == boost::system::system_category();
    host->complain(host->context, error.code().message().c_str(),
                   is_of_system ? error.code().value() : 0);
  } catch (const std::exception& error) {
    host->complain(host->context, error.what(), 0);
  }
  return nullptr;
}

std::uint16_t port(const MicrotraceHttpServer* server) {
  return server->server.port();
}

void run(MicrotraceHttpServer* server) {
  try {
    server->server.run();
  } catch (const std::exception& error) {
    const MicrotraceHttpHost& host = server->server.host();
    host.complain(host.context, error.what(), 0);
  }
}

void reply(MicrotraceHttpServer* server, void* exchange, const MicrotraceHttpResponse* response) {
  const std::unique_ptr<std::shared_ptr<Connection>> owner(
      static_cast<std::shared_ptr<Connection>*>(exchange));
  Connection::Response message =
      make_response(response->status, response->type,
                    std::string(static_cast<const char*>(response->body), response->size),
                    server->server.allowed_host());
  if (*response->header != 0) message.set("Microtrace-Picture", response->header);
  if (*response->file != 0) {
    message.set(boost::beast::http::field::content_disposition,
                "attachment; filename=\"" + std::string(response->file) + "\"");
  }
  boost::asio::post(server->server.context(),
                    [connection = std::move(*owner), message = std::move(message)]() mutable {
                      connection->write(std::move(message));
                    });
}

int is_awaited(void* exchange) {
  return (*static_cast<std::shared_ptr<Connection>*>(exchange))->is_open_at_client() ? 1 : 0;
}

void close(MicrotraceHttpServer* server) {
  delete server;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const MicrotraceHttp* microtrace_http_v3() {
  static constexpr MicrotraceHttp kFunctions{.open = open,
                                             .port = port,
                                             .run = run,
                                             .reply = reply,
                                             .is_awaited = is_awaited,
                                             .close = close};
  return &kFunctions;
}
