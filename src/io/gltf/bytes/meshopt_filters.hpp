#pragma once
/// The filters of KHR_meshopt_compression, appendix B. They give the same bytes on every platform,
/// because they use only integers, and + - * / and sqrt in float32.

#include <string>

namespace microtrace::io::gltf {

/// Decodes unit vectors of 4 or 8 bytes, stored as octahedral coordinates.
void decode_octahedral(std::string& bytes, std::size_t stride);

/// Decodes unit quaternions of 8 bytes, stored as their three smaller components.
void decode_quaternions(std::string& bytes);

/// Decodes float32 numbers, stored as an exponent of 8 bits and a mantissa of 24 bits.
void decode_exponential(std::string& bytes);

/// Decodes colors of 4 or 8 bytes, stored as luma, chroma and alpha (YCoCg).
void decode_colors(std::string& bytes, std::size_t stride);

}  // namespace microtrace::io::gltf
