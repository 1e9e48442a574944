#pragma once
/// The library's error type, and diagnostics with positions in files.

#include <microtrace/export.hpp>

#include <cstddef>
#include <stdexcept>
#include <string>

namespace microtrace {

/// Kinds of errors. Their values are the exit codes of the program.
enum class ErrorKind {
  internal = 1,       ///< an internal failure, which is a defect of the library
  usage = 2,          ///< an invalid request
  invalid_scene = 3,  ///< the scene file violates its format
  unsupported = 4,    ///< the scene requires an unsupported feature
  io = 5,             ///< a file can't be read or written
  limit = 6,          ///< a documented limit was exceeded
  canceled = 7,       ///< a callback requested to stop; never an exit code of the program,
                      ///< whose code 7 means that compared pictures differ
};

enum class Severity {
  warning,  ///< something unusual, or a feature that is ignored
  error,    ///< a violation of the file's format
};

/// A message about a position in a file. Members whose value is unknown are empty or 0.
struct MICROTRACE_EXPORT Diagnostic {
  std::string file;        ///< as the user named it
  std::size_t line = 0;    ///< counted from 1
  std::size_t column = 0;  ///< in bytes, counted from 1
  std::string pointer;     ///< JSON pointer (RFC 6901)
  std::string message;     ///< the problem and the remedy
  std::string excerpt;     ///< the source line, shortened to the width of a screen, and a second
                           ///< line with a caret
  Severity severity = Severity::warning;  ///< of a diagnostic that is returned, not thrown
  int system_error = 0;                   ///< the value of errno, if a call of the system failed

  /// Returns `file:line:col: /json/pointer: message`, followed by the excerpt on separate lines.
  [[nodiscard]] std::string text() const;
};

/// The exception that functions of the library throw when they fail.
class MICROTRACE_EXPORT Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, Diagnostic where);
  Error(ErrorKind kind, std::string file, std::string message, int system_error = 0);

  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
  [[nodiscard]] const Diagnostic& diagnostic() const noexcept { return diagnostic_; }

 private:
  ErrorKind kind_;
  Diagnostic diagnostic_;
};

}  // namespace microtrace
