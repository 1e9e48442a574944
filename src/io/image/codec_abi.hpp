#pragma once
/// The C interface between the library and its module of image codecs. A change of anything here
/// takes a new number in a function's name, so that an old module is refused instead of misread.

#include <cstddef>
#include <cstdint>

extern "C" {

struct MicrotraceImageHeader {
  std::uint32_t width, height;
  std::uint32_t channels;  ///< 1: grey, 2: grey and alpha, 3: rgb, 4: rgb and alpha
  std::uint32_t depth;     ///< bits of a sample, 8 or 16; these lie in the machine's byte order
};

struct MicrotraceImageSink {
  void* context;  ///< the caller's
  /// Where the samples go, row by row from the upper left; null ends the decoding. Called once.
  void* (*begin)(void* context, const MicrotraceImageHeader* header);
  /// Takes the reason of a failure, or what is wrong with the file of an image that was decoded
  /// nevertheless. Neither function throws.
  void (*complain)(void* context, const char* text);
};

/// Decodes a PNG, JPEG, WebP or KTX2 file: 1 if there is an image now, else 0. ICC profiles and
/// gamma are ignored.
using MicrotraceDecode = int (*)(const void* bytes, std::size_t size,
                                 const MicrotraceImageSink* sink);

/// A tEXt chunk.
struct MicrotracePngText {
  const char* keyword;  ///< 1 to 79 letters of Latin-1
  const char* text;
};

/// A picture of 8 bits a sample, and where its file goes. No function throws.
struct MicrotracePng {
  std::uint32_t width, height;
  std::uint32_t channels;  ///< 3: rgb, 4: rgb and alpha, which is not multiplied into it
  std::uint32_t is_srgb;   ///< else the file has no colour space
  const MicrotracePngText* texts;
  std::size_t text_count;
  void* context;  ///< the caller's
  /// The samples of a row, asked for once each, from the upper one on.
  const unsigned char* (*row)(void* context, std::uint32_t y);
  /// Takes the next bytes of the file; 0 ends the writing.
  int (*take)(void* context, const void* bytes, std::size_t size);
  void (*complain)(void* context, const char* text);  ///< takes the reason of a failure
};

/// Writes a PNG file that depends on these alone: 1 if all of it was taken, else 0.
using MicrotraceEncodePng = int (*)(const MicrotracePng* picture);
}

namespace microtrace::io {

inline constexpr char codec_module_file_name[] = "microtrace_codecs.so";
inline constexpr char decode_name[] = "microtrace_decode_v1";
inline constexpr char encode_png_name[] = "microtrace_encode_png_v2";

}  // namespace microtrace::io
