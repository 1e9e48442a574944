#pragma once
/// The modules of picture formats other than PPM and PNG. Each is loaded when it is first needed:
/// OpenImageIO and the 260 libraries it brings cost a quarter of a second and 130 MB.

#include "io/image/module_abi.hpp"

#include <microtrace/film.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace microtrace::io {

struct FormatModule {
  const char* file;
  const char* package;  ///< Debian's, which it is built with
  const char* target;   ///< CMake's, which builds it
  /// Libraries that Debian's OpenImageIO depends on start threads while they are loaded, and end
  /// the process where they can't.
  bool starts_threads = false;
};

/// What writes pictures and reads environments of this ending (lower case, no dot).
[[nodiscard]] const FormatModule& module_for(std::string_view ending);

/// To be called before the module is loaded for `file`. Throws Error (limit) where it starts
/// threads that the system would refuse.
void require_threads(const FormatModule& module, const std::string& file);

class ImageModule {
 public:
  /// Loads the module for this ending, once in a process. `file` stands in messages.
  /// Throws Error(unsupported) that names the places where the module was sought.
  ImageModule(std::string file, std::string_view ending);

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
