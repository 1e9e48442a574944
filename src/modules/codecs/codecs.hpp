#pragma once
/// Declares a decoder for each file format, and the PNG encoder. Each function returns 1 on success
/// and 0 on failure.

#include "io/image/codec_abi.hpp"

#include <cstddef>

int decode_png(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink);
int decode_jpeg(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink);
int decode_webp(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink);
int decode_ktx2(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink);
int encode_png(const MicrotracePng& picture);

// Zstandard, see MicrotraceCompress and MicrotraceDecompress.
std::size_t compress(void* to, std::size_t capacity, const void* from, std::size_t size);
int decompress(void* to, std::size_t size, const void* from, std::size_t compressed);

// Raw deflate, see kInflateName.
int inflate_raw(void* to, std::size_t size, const void* from, std::size_t compressed);
