#include "cli/report/standard_output.hpp"

#include <microtrace/error.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace microtrace::cli {

void write_standard_output(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) != EOF && std::fflush(stdout) == 0) return;
  throw Error(ErrorKind::io, "standard output",
              std::string("can't be written: ") + std::strerror(errno) + "; make room");
}

}  // namespace microtrace::cli
