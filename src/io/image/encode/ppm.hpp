#pragma once
/// Writes PPM, the portable pixmap of Netpbm: https://netpbm.sourceforge.net/doc/ppm.html

#include <microtrace/film.hpp>
#include <microtrace/io.hpp>

#include <cstdint>
#include <string>

namespace microtrace::io {

/// Returns three lines without comments: the magic number, the width and height, and the maximum
/// 255.
[[nodiscard]] std::string ppm_header(ImageSize size, PpmEncoding encoding);

/// Appends row y of the picture, which must not have alpha. Lines of P3 have at most 70 characters,
/// as the format requires.
void append_ppm_row(const Film& film, std::uint32_t y, PpmEncoding encoding, std::string& out);

}  // namespace microtrace::io
