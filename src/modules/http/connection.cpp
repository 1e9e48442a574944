#include "modules/http/connection.hpp"

#include "modules/http/access.hpp"

#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <cerrno>
#include <chrono>
#include <string_view>
#include <sys/socket.h>
#include <utility>

namespace microtrace::http {

namespace beast = boost::beast;
using beast::http::field;
using beast::http::status;

namespace {

constexpr std::chrono::seconds kTimeToSend{20};     // for the browser, from its first byte on
constexpr std::chrono::seconds kTimeToWait{120};    // between two requests
constexpr std::chrono::minutes kTimeToReceive{10};  // a large picture through a slow tunnel

std::string_view view_of(beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

Connection::Response make_response(unsigned status, const std::string& type, std::string body,
                                   const std::string& allowed_host) {
  Connection::Response response;
  response.result(status);
  response.set(field::content_type, type);
  response.set(field::cache_control, "no-store");
  // The address contains the token.
  response.set("Referrer-Policy", "no-referrer");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  // Notebooks of Jupyter and editors show the page in a frame.
  std::string frames =
      "'self' http://localhost:* http://127.0.0.1:* https://localhost:* "
      "vscode-webview:";
  if (const auto host = split_host(allowed_host)) frames += " https://" + host->name + ":*";
  response.set("Content-Security-Policy",
               "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: "
               "data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors " +
                   frames);
  response.body() = std::move(body);
  return response;
}

Connection::Connection(Server& server, boost::asio::ip::tcp::socket socket)
    : server_(server), stream_(std::move(socket)) {
  server_.count_connections(1);
}

Connection::~Connection() {
  end_quiet();
  server_.count_connections(-1);
}

void Connection::begin_quiet() {
  Server::Quiet& all = server_.quiet();
  if (!quiet_) quiet_ = all.insert(all.end(), this);
}

void Connection::end_quiet() {
  if (quiet_) server_.quiet().erase(*quiet_);
  quiet_.reset();
}

void Connection::close() {
  end_quiet();
  boost::system::error_code ignored;
  stream_.socket().close(ignored);
}

void Connection::read() {
  begin_quiet();
  if (buffer_.size() > 0) return receive();  // a request that follows the previous one at once
  stream_.expires_after(kTimeToWait);
  // Waits for the first byte. receive() limits the time for the rest.
  stream_.async_read_some(
      buffer_.prepare(1),
      [self = shared_from_this()](const boost::system::error_code& error, std::size_t size) {
        if (error) return;
        self->buffer_.commit(size);
        self->receive();
      });
}

void Connection::receive() {
  parser_.emplace();
  parser_->header_limit(kMostHeader);
  parser_->body_limit(kMostBody);
  stream_.expires_after(kTimeToSend);
  beast::http::async_read(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](const boost::system::error_code& failure, std::size_t) {
        using beast::http::error;
        if (failure == error::body_limit)
          self->refuse(status::payload_too_large, "too long");
        else if (failure == error::header_limit || failure == error::buffer_overflow)
          self->refuse(status::request_header_fields_too_large, "too long");
        else if (failure.category() == make_error_code(error::bad_method).category() &&
                 failure != error::end_of_stream && failure != error::partial_message)
          self->refuse(status::bad_request, failure.message());
        else if (!failure)
          self->answer();
      });
}

void Connection::answer() {
  end_quiet();
  const auto& request = parser_->get();
  const std::string_view host = view_of(request[field::host]);
  const std::string_view origin = view_of(request[field::origin]);
  if (request.count(field::host) != 1 || !is_own_host(host, server_.allowed_host())) {
    return refuse(status::forbidden,
                  "the host name in the address must be localhost or 127.0.0.1; --allow-host adds "
                  "another one");
  }
  if (request.count(field::origin) > 1 ||
      (!origin.empty() && !is_own_origin(origin, host, server_.allowed_host()))) {
    return refuse(
        status::forbidden,
        "pages of other origins must not use this server; --allow-host names the host of a "
        "proxy, and its port if it is not the default one");
  }
  std::string_view path = view_of(request.target());
  std::string query;
  if (const std::size_t mark = path.find('?'); mark != std::string_view::npos) {
    query = path.substr(mark + 1);
    path = path.substr(0, mark);
  }
  const std::string& token = server_.token();
  if (!path.starts_with('/') || !are_equal(path.substr(1, path.find('/', 1) - 1), token)) {
    return refuse(status::forbidden,
                  "the address must contain the token that microtrace printed when it started");
  }
  path.remove_prefix(std::min(path.size(), token.size() + 1));
  if (path.empty()) {
    // Relative addresses in the page need the slash. The location is relative because a proxy may
    // have removed the beginning of the path.
    Response redirection = make_response(301, "text/plain", "", server_.allowed_host());
    redirection.set(field::location, token + "/" + (query.empty() ? "" : "?" + query));
    return write(std::move(redirection));
  }
  path.remove_prefix(1);
  const std::string method(view_of(request.method_string())), name(path);
  const MicrotraceHttpRequest received{.method = method.c_str(),
                                       .path = name.c_str(),
                                       .query = query.c_str(),
                                       .body = request.body().data(),
                                       .size = request.body().size()};
  const MicrotraceHttpHost& program = server_.host();
  program.handle(program.context, &received, new std::shared_ptr<Connection>(shared_from_this()));
}

bool Connection::is_open_at_client() {
  char next = 0;
  const ssize_t got = ::recv(stream_.socket().native_handle(), &next, 1, MSG_PEEK | MSG_DONTWAIT);
  return got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR));
}

void Connection::refuse(status code, const std::string& text) {
  Response response =
      make_response(static_cast<unsigned>(code), "text/plain; charset=utf-8",
                    "The request is refused: " + text + ".\n", server_.allowed_host());
  response.keep_alive(false);
  write(std::move(response));
}

void Connection::write(Response response) {
  end_quiet();
  response_ = std::move(response);
  const bool is_read = parser_->is_done();
  response_.version(11);
  response_.keep_alive(response_.keep_alive() && is_read && parser_->get().keep_alive());
  // The response to HEAD has the length, but not the body.
  const bool is_head = is_read && parser_->get().method() == beast::http::verb::head;
  const std::size_t length = response_.body().size();
  if (is_head) response_.body().clear();
  // RFC 9110, section 8.6: responses without content have no length.
  if (response_.result() != beast::http::status::no_content) response_.content_length(length);
  stream_.expires_after(kTimeToReceive);
  beast::http::async_write(
      stream_, response_,
      [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
        if (error) return;
        if (self->response_.keep_alive()) return self->read();
        boost::system::error_code ignored;
        self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
      });
}

}  // namespace microtrace::http
