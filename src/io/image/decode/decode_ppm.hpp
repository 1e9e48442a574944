#pragma once
#include <microtrace/texture.hpp>

#include <string>
#include <string_view>

namespace microtrace::io {

/// Returns true if a file begins as a PGM file (P2 or P5) or PPM file (P3 or P6).
[[nodiscard]] bool is_ppm(std::string_view bytes);

/// Reads a PGM or PPM file (https://netpbm.sourceforge.net/doc/pgm.html and ppm.html) with samples
/// of up to 16 bits, scaled to 8 or 16 bits. Throws Error, with the file's name: io if it is
/// damaged, unsupported if it contains more than one picture, limit if it is too large.
[[nodiscard]] Image decode_ppm(std::string_view bytes, const std::string& name);

}  // namespace microtrace::io
