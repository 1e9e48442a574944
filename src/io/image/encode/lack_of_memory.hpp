#pragma once
#include <microtrace/error.hpp>

#include <string>

namespace microtrace::io {

/// The error of an encoder that ran out of memory. `file` is the picture's.
[[nodiscard]] inline Error lack_of_memory(const std::string& file) {
  return Error(ErrorKind::limit, file,
               "can't be encoded: out of memory; write .ppm, or a smaller picture");
}

}  // namespace microtrace::io
