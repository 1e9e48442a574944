#pragma once
/// The C interface between the program and its module that serves HTTP. If the interface changes,
/// the number in the function's name must change too. An old module is then rejected instead of
/// called with the wrong arguments.

#include <cstddef>
#include <cstdint>

extern "C" {

/// A request whose address, Host and Origin were accepted. Valid during the call only.
struct MicrotraceHttpRequest {
  const char* method;  ///< "GET", "POST", ...
  const char* path;    ///< after the token and its slash, without the query; "" for the page itself
  const char* query;   ///< after '?', not decoded; "" if there is none
  const void* body;
  std::size_t size;  ///< of the body, in bytes
};

struct MicrotraceHttpResponse {
  unsigned status;
  const char* type;    ///< media type of the body
  const char* header;  ///< value of the header field Microtrace-Picture; "" if there is none
  const char* file;    ///< name under which a browser saves the body; "" if it shows the body
  const void* body;    ///< copied before reply() returns
  std::size_t size;
};

/// The program's part. No callback throws.
struct MicrotraceHttpHost {
  std::uint16_t port;        ///< 0: any free port
  const char* token;         ///< the first part of each path, of letters and digits
  const char* allowed_host;  ///< NAME or NAME:PORT to accept besides the loopback; "" for none
  void* context;             ///< passed to the functions
  /// Receives a request, for which reply() must be called once, at any time and by any thread.
  void (*handle)(void* context, const MicrotraceHttpRequest* request, void* exchange);
  /// Called ten times a second by run(), which returns if the result is 0.
  int (*goes_on)(void* context);
  /// Receives the reason for a failure, and errno or 0.
  void (*complain)(void* context, const char* text, int system_error);
};

struct MicrotraceHttpServer;

/// The module's functions. `open` binds to the loopback and returns null on failure. `reply` and
/// `is_awaited` may be called until `close`, by any thread. `is_awaited` returns 0 if the client
/// has closed its connection, and must not be called after `reply` for the same exchange.
struct MicrotraceHttp {
  MicrotraceHttpServer* (*open)(const MicrotraceHttpHost* host);
  std::uint16_t (*port)(const MicrotraceHttpServer* server);
  void (*run)(MicrotraceHttpServer* server);
  void (*reply)(MicrotraceHttpServer* server, void* exchange,
                const MicrotraceHttpResponse* response);
  int (*is_awaited)(void* exchange);
  void (*close)(MicrotraceHttpServer* server);
};

using MicrotraceHttpFunctions = const MicrotraceHttp* (*)();
}

namespace microtrace::io {

inline constexpr char kHttpModuleFileName[] = "microtrace_http.so";
inline constexpr char kHttpFunctionsName[] = "microtrace_http_v3";

}  // namespace microtrace::io
