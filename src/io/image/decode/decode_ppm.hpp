#pragma once
#include <microtrace/texture.hpp>

#include <string>
#include <string_view>

namespace microtrace::io {

/// Reads a PPM file (P3 or P6, https://netpbm.sourceforge.net/doc/ppm.html) with samples of up to
/// 16 bits, scaled to 8 or 16 bits. Throws Error, with the file's name: io if it is damaged, limit
/// if it is too large.
[[nodiscard]] Image decode_ppm(std::string_view bytes, const std::string& name);

}  // namespace microtrace::io
