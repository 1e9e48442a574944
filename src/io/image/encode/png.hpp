#pragma once
/// Writes PNG (ISO/IEC 15948) by the codec module, which is loaded when needed.

#include "io/image/codec_abi.hpp"

#include <microtrace/film.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace microtrace::io {

class PngEncoder {
 public:
  /// Loads the module. Messages name `file`. Throws an Error(unsupported) that lists the searched
  /// folders.
  explicit PngEncoder(std::string file);

  /// Passes the file to `out` in parts. It has 8 bits per sample according to the film's display
  /// settings, and alpha if the film has it. Throws the exceptions of `out`, and Error(io).
  void encode(const Film& film, const std::function<void(std::string_view)>& out) const;

 private:
  std::string file_;
  MicrotraceEncodePng encode_ = nullptr;
};

}  // namespace microtrace::io
