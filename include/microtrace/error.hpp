#pragma once
/// The one error type, and the place in a file that it speaks of.

#include <microtrace/export.hpp>

#include <cstddef>
#include <stdexcept>
#include <string>

namespace microtrace {

/// What went wrong; the number is the exit code of the program.
enum class ErrorKind {
  internal = 1,       ///< a failure inside
  usage = 2,          ///< a request that makes no sense
  invalid_scene = 3,  ///< the scene file breaks its format's rules
  unsupported = 4,    ///< the scene requires a feature that is not there
  io = 5,             ///< a file can't be read or written
  limit = 6,          ///< a documented limit was reached
  canceled = 7,       ///< a callback asked to stop; never an exit code of the program
};

enum class Severity {
  warning,  ///< an oddity, or a feature without effect
  error,    ///< the file breaks a rule of its format
};

/// One message about one place. Parts that are unknown are empty or 0.
struct MICROTRACE_EXPORT Diagnostic {
  std::string file;        ///< as the user named it
  std::size_t line = 0;    ///< from 1
  std::size_t column = 0;  ///< in bytes, from 1
  std::string pointer;     ///< JSON pointer (RFC 6901)
  std::string message;     ///< what is wrong and what to do
  std::string excerpt;     ///< the line itself, at most a screen wide, then a line with a caret
  Severity severity = Severity::warning;  ///< of a diagnostic that is returned, not thrown

  /// `file:line:col: /json/pointer: message`, then the excerpt on lines of its own.
  [[nodiscard]] std::string text() const;
};

/// Thrown by every function of the library that can fail.
class MICROTRACE_EXPORT Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, Diagnostic where);
  Error(ErrorKind kind, std::string file, std::string message);

  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
  [[nodiscard]] const Diagnostic& diagnostic() const noexcept { return diagnostic_; }

 private:
  ErrorKind kind_;
  Diagnostic diagnostic_;
};

}  // namespace microtrace
