#pragma once
/// The C interface between the library and its modules of picture formats: OpenEXR for .exr,
/// OpenImageIO for all others but PPM and PNG. A change of anything here takes
/// a new number in the functions' names, so that an old module is refused instead of misread.

#include <cstddef>
#include <cstdint>

extern "C" {

/// What files of one ending hold.
struct MicrotraceFormat {
  std::int32_t is_float;      ///< linear float32, else 8 bits
  std::int32_t has_alpha;     ///< beside red, green and blue
  std::int32_t has_channels;  ///< any number of them by any name, each of any MicrotraceNumber
};

enum MicrotraceNumber : std::int32_t {
  kMicrotraceU8,
  kMicrotraceU32,
  kMicrotraceF32,
  kMicrotraceU16,  ///< only decoded
};

struct MicrotraceChannel {
  const char* name;    ///< R, G, B, then A if there is alpha, then others
  const void* first;   ///< the upper left pixel's number
  std::size_t stride;  ///< bytes from pixel to pixel; rows follow each other
  MicrotraceNumber number;
};

/// A text in the file's header, where the format has room for it.
struct MicrotraceNote {
  const char* name;
  const char* text;
};

/// 8-bit alpha is not multiplied into the colours, float alpha is.
struct MicrotracePicture {
  std::uint32_t width, height;
  std::uint32_t x0, y0;                     ///< of the upper left pixel in the whole picture
  std::uint32_t whole_width, whole_height;  ///< of which this may be a part
  std::int32_t is_color;                    ///< sRGB, where it is 8 bits, else numbers of any kind
  const MicrotraceChannel* channels;
  std::size_t channel_count;
  const MicrotraceNote* notes;
  std::size_t note_count;
};

/// Takes text or bytes; `context` is the caller's. Never throws.
using MicrotraceSink = void (*)(void* context, const char* bytes, std::size_t size);

/// Can pictures be written for this ending (small letters, no dot)? Describes them and returns 1,
/// or returns 0.
using MicrotraceFindFormat = int (*)(const char* ending, MicrotraceFormat* format);

/// Hands the bytes of the picture's file to `out` and returns 0, or hands a reason to `error` and
/// returns 1. The channels are such as the format has.
using MicrotraceEncode = int (*)(const MicrotracePicture* picture, const char* ending,
                                 MicrotraceSink out, MicrotraceSink error, void* context);

/// The colours of a decoded picture.
struct MicrotraceColors {
  std::uint32_t width, height;
  std::uint32_t channels;   ///< 1: grey, 3: rgb
  MicrotraceNumber number;  ///< U8, U16 or F32
};

struct MicrotraceColorSink {
  void* context;  ///< the caller's
  /// Where the samples go, row by row from the upper left; null ends the decoding. Called once.
  void* (*begin)(void* context, const MicrotraceColors* colors);
  /// Takes the reason of a failure. Neither function throws.
  void (*complain)(void* context, const char* text);
};

/// Decodes the first picture of a file of this ending (small letters, no dot) without its alpha:
/// returns 1, or complains and returns 0.
using MicrotraceDecodeColors = int (*)(const void* bytes, std::size_t size, const char* ending,
                                       const MicrotraceColorSink* sink);
}

namespace microtrace::io {

inline constexpr char find_format_name[] = "microtrace_find_format_v3";
inline constexpr char encode_name[] = "microtrace_encode_v3";
inline constexpr char decode_colors_name[] = "microtrace_decode_colors_v1";

}  // namespace microtrace::io
