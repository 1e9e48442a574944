#pragma once
/// Conversion of a film's pixels to 8 bits.

#include <microtrace/film.hpp>

#include <cstdint>

namespace microtrace::io {

/// Writes red, green and blue of row y, and alpha if the film has it, according to the film's
/// display settings. `out` must have room for the row. Alpha is round(255 alpha); colors are
/// divided by alpha before encoding; a pixel with alpha 0 is all zeros.
void encode_row(const Film& film, std::uint32_t y, std::uint8_t* out);

}  // namespace microtrace::io
