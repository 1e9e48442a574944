#pragma once
/// One connection of a browser, which may send several requests, one after another.

#include "modules/http/server.hpp"

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace microtrace::http {

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Server& server, boost::asio::ip::tcp::socket socket);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Reads and answers the next request.
  void read();

  /// Ends a connection that is one of Server::quiet().
  void close();

  using Response = boost::beast::http::response<boost::beast::http::string_body>;
  /// Sends the response to the current request. Must be called on the thread of Server::run().
  void write(Response response);

  /// Returns false if the client has closed the connection. May be called by any thread while the
  /// current request waits for its response.
  [[nodiscard]] bool is_open_at_client();

 private:
  /// The file system's and the program's limits are far higher; requests of the page are short.
  static constexpr std::uint32_t kMostHeader = 16 << 10;
  static constexpr std::uint64_t kMostBody = 64 << 10;

  void receive();
  void begin_quiet();
  void end_quiet();
  void answer();
  void refuse(boost::beast::http::status status, const std::string& text);

  Server& server_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_{kMostHeader + kMostBody};
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  Response response_;
  std::optional<Server::Quiet::iterator> quiet_;
};

/// Makes a response with the header fields that all responses have.
[[nodiscard]] Connection::Response make_response(unsigned status, const std::string& type,
                                                 std::string body, const std::string& allowed_host);

}  // namespace microtrace::http
