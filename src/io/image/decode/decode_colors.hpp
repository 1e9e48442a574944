#pragma once
/// Decodes pictures by the modules for OpenEXR and OpenImageIO.

#include "io/image/module_abi.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace microtrace::io {

struct DecodedColors {
  MicrotraceColors colors{};
  /// Row by row from the upper left; the type is that of colors.number.
  std::variant<std::vector<float>, std::vector<std::uint8_t>, std::vector<std::uint16_t>> samples{};
};

/// Words for error messages.
struct PicturePurpose {
  const char* what;       ///< "an environment"
  const char* hint;       ///< what a file of another kind lacks
  const char* otherwise;  ///< what works without the module
};

/// Decodes the bytes of the file at `path`. Throws Error: io if they can't be decoded, limit for a
/// side above 65536 pixels, more than 2^27 pixels or lack of memory, unsupported if the module is
/// not installed.
[[nodiscard]] DecodedColors decode_colors(const std::string& bytes,
                                          const std::filesystem::path& path,
                                          const PicturePurpose& purpose);

}  // namespace microtrace::io
