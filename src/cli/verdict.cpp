#include "cli/verdict.hpp"

#include "base/printable.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace microtrace::cli {
namespace {

const char* word_for(ErrorKind kind) {
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
      break;
  }
  return "not judged";
}

std::string count_of(std::size_t number, const char* what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

}  // namespace

void print_findings(const std::string& scene, std::size_t errors, std::size_t warnings) {
  std::string verdict =
      errors == 0 ? "valid" : "invalid, but drawable: " + count_of(errors, "error");
  if (warnings != 0) verdict += ", " + count_of(warnings, "warning");
  std::printf("%s: %s\n", printable(scene).c_str(), verdict.c_str());
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw Error(ErrorKind::io, "standard output",
              std::string("can't be written: ") + std::strerror(errno) + "; make room");
}

void print_refused(const std::string& scene, ErrorKind kind) {
  std::printf("%s: %s\n", printable(scene).c_str(), word_for(kind));
}

}  // namespace microtrace::cli
