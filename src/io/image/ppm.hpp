#pragma once
/// PPM, the portable pixmap of Netpbm: https://netpbm.sourceforge.net/doc/ppm.html

#include <microtrace/film.hpp>
#include <microtrace/io.hpp>

#include <cstdint>
#include <string>

namespace microtrace::io {

/// Magic number, width, height and 255, a line each pair; no comment.
[[nodiscard]] std::string ppm_header(ImageSize size, PpmEncoding encoding);

/// Appends row y of the picture, which has no alpha. Lines of P3 hold at most 70 characters, as the
/// format asks.
void append_ppm_row(const Film& film, std::uint32_t y, PpmEncoding encoding, std::string& out);

}  // namespace microtrace::io
