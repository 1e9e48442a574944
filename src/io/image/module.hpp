#pragma once
/// The modules of image formats other than PPM and PNG. Each is loaded when first needed, because
/// OpenImageIO and the 260 libraries on which it depends take a quarter of a second and 130 MB.

#include "io/image/module_abi.hpp"

#include <microtrace/film.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace microtrace::io {

struct FormatModule {
  const char* file;
  const char* package;  ///< name of the Debian package that is needed to build the module
  const char* target;   ///< CMake target of the module
  /// True if libraries of the module start threads while they are loaded, and end the process if
  /// they can't. Dependencies of Debian's OpenImageIO do this.
  bool starts_threads = false;
};

/// The module that writes pictures and reads environment maps with this extension (lower case, no
/// dot).
[[nodiscard]] const FormatModule& module_for(std::string_view extension);

/// Throws Error (limit) if the module starts more threads than the system allows. Must be called
/// before the module is loaded. Messages name `file`.
void require_threads(const FormatModule& module, const std::string& file);

class ImageModule {
 public:
  /// Loads the module for this extension, once per process. Messages name `file`. Throws an
  /// Error(unsupported) that lists the searched folders.
  ImageModule(std::string file, std::string_view extension);

  /// Returns the pixel format of files with this extension (lower case, no dot). Throws
  /// Error(usage) if the module can't write them.
  [[nodiscard]] MicrotraceFormat find_format(const std::string& extension) const;

  /// Passes all bytes of the picture's file to `out`. Throws Error: limit if memory runs out, else
  /// io.
  void encode(const Film& film, const std::string& extension,
              const std::function<void(std::string_view)>& out) const;

 private:
  std::string file_;
  MicrotraceFindFormat find_format_ = nullptr;
  MicrotraceEncode encode_ = nullptr;
};

}  // namespace microtrace::io
