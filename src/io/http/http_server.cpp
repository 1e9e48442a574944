#include "io/http/http_server.hpp"

#include "io/module_function.hpp"

#include <microtrace/error.hpp>

#include <atomic>
#include <cerrno>
#include <exception>
#include <utility>

namespace microtrace::io {
namespace {

const MicrotraceHttp& load_module() {
  const ModuleFunction function = find_module_function(kHttpModuleFileName, kHttpFunctionsName);
  if (function.address == nullptr) {
    throw Error(ErrorKind::unsupported, "",
                "no page can be served: " + function.complaint +
                    "; install libboost-dev and build the target microtrace_http, or set "
                    "MICROTRACE_MODULE_PATH to its folder");
  }
  return *reinterpret_cast<MicrotraceHttpFunctions>(function.address)();
}

/// A request that waits for its response.
class Exchange {
 public:
  Exchange(const MicrotraceHttp& http, MicrotraceHttpServer* server, void* exchange)
      : http_(http), server_(server), exchange_(exchange) {}
  ~Exchange() { reply({.status = 503, .body = "The server is stopping.\n"}); }
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  void reply(const HttpResponse& response) {
    void* exchange = exchange_.exchange(nullptr);
    if (exchange == nullptr) return;
    const MicrotraceHttpResponse sent{.status = response.status,
                                      .type = response.type.c_str(),
                                      .header = response.picture.c_str(),
                                      .file = response.file.c_str(),
                                      .body = response.body.data(),
                                      .size = response.body.size()};
    http_.reply(server_, exchange, &sent);
  }

  [[nodiscard]] bool is_awaited() const {
    void* exchange = exchange_.load();
    return exchange != nullptr && http_.is_awaited(exchange) != 0;
  }

 private:
  const MicrotraceHttp& http_;
  MicrotraceHttpServer* server_;
  std::atomic<void*> exchange_;
};

}  // namespace

struct HttpServer::Exchanges {
  explicit Exchanges(Handler handler) : http(load_module()), handle(std::move(handler)) {}

  /// Calls a function and keeps its exception, because exceptions must not propagate through the
  /// module's frames.
  template <class Function>
  void guard(const Function& function) {
    try {
      function();
    } catch (...) {
      if (!thrown) thrown = std::current_exception();
    }
  }

  const MicrotraceHttp& http;
  Handler handle;
  MicrotraceHttpServer* server = nullptr;
  const std::function<bool()>* goes_on = nullptr;
  std::string complaint{};
  int system_error = 0;  // of the complaint
  std::exception_ptr thrown{};
};

HttpServer::HttpServer(const Options& options, Handler handle)
    : exchanges_(std::make_unique<Exchanges>(std::move(handle))) {
  MicrotraceHttpHost host{};
  host.port = options.port;
  host.token = options.token.c_str();
  host.allowed_host = options.allowed_host.c_str();
  host.context = exchanges_.get();
  host.handle = [](void* context, const MicrotraceHttpRequest* request, void* exchange) {
    auto& self = *static_cast<Exchanges*>(context);
    self.guard([&] {
      const auto pending = std::make_shared<Exchange>(self.http, self.server, exchange);
      self.handle({.method = request->method,
                   .path = request->path,
                   .query = request->query,
                   .body = {static_cast<const char*>(request->body), request->size}},
                  {[pending](const HttpResponse& response) { pending->reply(response); },
                   [pending] { return pending->is_awaited(); }});
    });
  };
  host.goes_on = [](void* context) {
    auto& self = *static_cast<Exchanges*>(context);
    bool goes_on = false;
    if (!self.thrown) self.guard([&] { goes_on = (*self.goes_on)(); });
    return goes_on ? 1 : 0;
  };
  host.complain = [](void* context, const char* text, int system_error) {
    auto& self = *static_cast<Exchanges*>(context);
    self.system_error = system_error;
    self.guard([&] { self.complaint = text; });
  };
  exchanges_->server = exchanges_->http.open(&host);
  if (exchanges_->server == nullptr) {
    const int code = exchanges_->system_error;
    const bool is_taken = code == EADDRINUSE || code == EACCES || code == EADDRNOTAVAIL;
    throw Error(
        ErrorKind::io, "",
        (options.port == 0 ? std::string("a free port") : "port " + std::to_string(options.port)) +
            " of 127.0.0.1 can't be used: " + exchanges_->complaint +
            (is_taken ? "; choose another port" : ""),
        code);
  }
}

HttpServer::~HttpServer() {
  exchanges_->http.close(exchanges_->server);
}

std::uint16_t HttpServer::port() const {
  return exchanges_->http.port(exchanges_->server);
}

void HttpServer::run(const std::function<bool()>& goes_on) {
  exchanges_->goes_on = &goes_on;
  exchanges_->http.run(exchanges_->server);
  exchanges_->goes_on = nullptr;
  if (exchanges_->thrown) std::rethrow_exception(std::exchange(exchanges_->thrown, nullptr));
  if (!exchanges_->complaint.empty())
    throw Error(ErrorKind::internal, "", "the page can't be served: " + exchanges_->complaint);
}

}  // namespace microtrace::io
