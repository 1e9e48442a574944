#pragma once
/// Converts a film's pixels to 8 bits.

#include <microtrace/film.hpp>

#include <cstdint>

namespace microtrace::io {

/// Writes red, green and blue of row y, and alpha if the film has it, according to the film's
/// display settings. `out` must have room for the row. Alpha is stored as round(255 alpha). Colors
/// are divided by alpha before encoding. A pixel with alpha 0 is all zeros.
void encode_row(const Film& film, std::uint32_t y, std::uint8_t* out);

}  // namespace microtrace::io
