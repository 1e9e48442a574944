#pragma once
/// A decoder for each file format: returns 1 on success, else 0. The encoder returns 1 if the file
/// is complete, else 0.

#include "io/image/codec_abi.hpp"

#include <cstddef>

int decode_png(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink);
int decode_jpeg(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink);
int decode_webp(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink);
int decode_ktx2(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink);
int encode_png(const MicrotracePng& picture);
