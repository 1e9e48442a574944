#include "base/text/printable.hpp"

#include <microtrace/error.hpp>

#include <utility>

namespace microtrace {
namespace {

Diagnostic about_file(std::string file, std::string message, int system_error) {
  Diagnostic diagnostic;
  diagnostic.file = std::move(file);
  diagnostic.message = std::move(message);
  diagnostic.system_error = system_error;
  return diagnostic;
}

}  // namespace

std::string Diagnostic::text() const {
  std::string out = printable(file);
  if (line != 0) out += ":" + std::to_string(line) + ":" + std::to_string(column);
  if (!out.empty()) out += ": ";
  if (!pointer.empty()) out += printable(pointer) + ": ";
  out += printable(message);
  if (!excerpt.empty()) out += "\n" + excerpt;
  return out;
}

Error::Error(ErrorKind kind, Diagnostic where)
    : std::runtime_error(where.text()), kind_(kind), diagnostic_(std::move(where)) {}

Error::Error(ErrorKind kind, std::string file, std::string message, int system_error)
    : Error(kind, about_file(std::move(file), std::move(message), system_error)) {}

}  // namespace microtrace
