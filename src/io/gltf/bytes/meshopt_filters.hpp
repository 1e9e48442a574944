#pragma once
/// The filters of EXT_meshopt_compression, appendix B, by + - * / and sqrt in float32 alone, so
/// that they give the same bytes everywhere.

#include <string>

namespace microtrace::io::gltf {

/// Unit vectors of 4 or 8 bytes, from octahedral coordinates.
void decode_octahedral(std::string& bytes, std::size_t stride);

/// Unit quaternions of 8 bytes, from their three lesser components.
void decode_quaternions(std::string& bytes);

/// Float32 numbers, from an exponent of 8 bits and a mantissa of 24.
void decode_exponential(std::string& bytes);

}  // namespace microtrace::io::gltf
