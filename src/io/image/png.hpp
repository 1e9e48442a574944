#pragma once
/// PNG (ISO/IEC 15948), written by the module of image codecs, which is loaded when it is needed.

#include "io/image/codec_abi.hpp"

#include <microtrace/film.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace microtrace::io {

class PngEncoder {
 public:
  /// Loads the module. `file` stands in messages. Throws Error(unsupported) that names the places
  /// where it was sought.
  explicit PngEncoder(std::string file);

  /// Hands the file to `out`, part by part: 8 bits a sample as the film's display says, with alpha
  /// where the film has it. Throws what `out` throws, and Error(io).
  void encode(const Film& film, const std::function<void(std::string_view)>& out) const;

 private:
  std::string file_;
  MicrotraceEncodePng encode_ = nullptr;
};

}  // namespace microtrace::io
