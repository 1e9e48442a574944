#pragma once
/// A film's pixels as 8-bit formats hold them.

#include <microtrace/film.hpp>

#include <cstdint>

namespace microtrace::io {

/// Writes red, green and blue of row y, and alpha where the film has it, as the film's display
/// says. `out` has room for the row. Alpha is round(255 alpha), and divided out of the colours
/// before they are encoded; a pixel with alpha 0 is all zeros.
void encode_row(const Film& film, std::uint32_t y, std::uint8_t* out);

}  // namespace microtrace::io
