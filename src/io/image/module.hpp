#pragma once
/// The module of picture formats other than PPM and PNG. It is loaded when it is first needed, for
/// OpenImageIO and the 260 libraries it brings cost a quarter of a second and 130 MB.

#include "io/image/module_abi.hpp"

#include <microtrace/film.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace microtrace::io {

/// To be called before the OpenImageIO module is loaded for `file`. Libraries that Debian's
/// OpenImageIO depends on start threads while they are loaded, and end the process where they
/// can't. Throws Error (limit) where the system would refuse these threads.
void require_threads_of_image_module(const std::string& file);

class ImageModule {
 public:
  /// Loads the module, once in a process. `file` stands in messages.
  /// Throws Error(unsupported) that names the places where the module was sought.
  explicit ImageModule(std::string file);

  /// What files of this ending (small letters, no dot) hold. Throws Error(usage) where none can be
  /// written.
  [[nodiscard]] MicrotraceFormat find_format(const std::string& ending) const;

  /// Hands the bytes of the whole picture file to `out`. Throws Error(io).
  void encode(const Film& film, const std::string& ending,
              const std::function<void(std::string_view)>& out) const;

 private:
  std::string file_;
  MicrotraceFindFormat find_format_ = nullptr;
  MicrotraceEncode encode_ = nullptr;
};

}  // namespace microtrace::io
