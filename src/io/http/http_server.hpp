#pragma once
/// Serves HTTP on the loopback interface by a module, which is loaded when needed.

#include "io/http/http_abi.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace microtrace::io {

/// A request for a path below the token. Paths and queries are not decoded.
struct HttpRequest {
  std::string method, path, query, body;
};

struct HttpResponse {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body{};
  std::string picture{};  ///< value of the header field Microtrace-Picture; ASCII; may be empty
  std::string file{};     ///< name under which a browser saves the body; may be empty
};

/// Sends the response to one request. Copies refer to the same request, and only the first response
/// is sent. If there is none when the last copy is destroyed, the status 503 is sent. May be used
/// by any thread, but no longer than the server exists.
class HttpReply {
 public:
  HttpReply(std::function<void(const HttpResponse&)> send, std::function<bool()> is_awaited)
      : send_(std::move(send)), is_awaited_(std::move(is_awaited)) {}

  void operator()(const HttpResponse& response) const { send_(response); }
  /// Returns false if the client has closed its connection. Must not be called after a response.
  [[nodiscard]] bool is_awaited() const { return is_awaited_(); }

 private:
  std::function<void(const HttpResponse&)> send_;
  std::function<bool()> is_awaited_;
};

class HttpServer {
 public:
  struct Options {
    std::uint16_t port = 0;      ///< 0: any free port
    std::string token{};         ///< the first part of each path, of letters and digits
    std::string allowed_host{};  ///< NAME or NAME:PORT to accept besides the loopback
  };
  /// Receives requests on the thread of run(). Must return soon.
  using Handler = std::function<void(HttpRequest, const HttpReply&)>;

  /// Loads the module and binds to the port on 127.0.0.1. Throws Error: unsupported if the module
  /// is missing, io if the port can't be bound.
  HttpServer(const Options& options, Handler handle);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// Serves until goes_on(), which is called ten times a second, returns false. Exceptions of the
  /// callbacks end the loop and are thrown.
  void run(const std::function<bool()>& goes_on);

 private:
  struct Exchanges;
  std::unique_ptr<Exchanges> exchanges_;
};

}  // namespace microtrace::io
