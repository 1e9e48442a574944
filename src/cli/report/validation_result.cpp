#include "cli/report/validation_result.hpp"

#include "base/counted.hpp"
#include "base/text/printable.hpp"
#include "cli/report/standard_output.hpp"

#include <cstdio>

namespace microtrace::cli {
namespace {

const char* result_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::invalid_scene:
      return "invalid";
    case ErrorKind::unsupported:
      return "unsupported";
    case ErrorKind::io:
      return "unreadable";
    case ErrorKind::limit:
      return "beyond a limit";
    case ErrorKind::internal:
    case ErrorKind::usage:
    case ErrorKind::canceled:
      break;
  }
  return "not checked";
}

}  // namespace

void print_validation_result(const std::string& scene, std::size_t errors, std::size_t warnings) {
  std::string result = errors == 0 ? "valid" : "invalid, but drawable: " + counted(errors, "error");
  if (warnings != 0) result += ", " + counted(warnings, "warning");
  write_standard_output(printable(scene) + ": " + result + "\n");
}

void print_refusal(const std::string& scene, ErrorKind kind) {
  std::printf("%s: %s\n", printable(scene).c_str(), result_of(kind));
}

}  // namespace microtrace::cli
