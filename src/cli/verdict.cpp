#include "cli/verdict.hpp"

#include <cstdio>

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

}  // namespace

void print_valid(const std::string& scene, std::size_t warnings) {
  std::printf("%s: valid", scene.c_str());
  if (warnings != 0) std::printf(", %zu warning%s", warnings, warnings == 1 ? "" : "s");
  std::printf("\n");
}

void print_refused(const std::string& scene, ErrorKind kind) {
  std::printf("%s: %s\n", scene.c_str(), word_for(kind));
}

}  // namespace microtrace::cli
