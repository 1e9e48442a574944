#pragma once
/// The C interface between the library and its modules of image formats: OpenEXR for .exr,
/// OpenImageIO for all others except PPM and PNG. Any change requires a new number in the
/// functions' names, so that an old module is refused instead of misread.

#include <cstddef>
#include <cstdint>

extern "C" {

/// The pixel format of files with one extension.
struct MicrotraceFormat {
  std::int32_t is_float;      ///< linear float32, else 8 bits
  std::int32_t has_alpha;     ///< in addition to red, green and blue
  std::int32_t has_channels;  ///< any number, with any names and any MicrotraceNumber
};

enum MicrotraceNumber : std::int32_t {
  kMicrotraceU8,
  kMicrotraceU32,
  kMicrotraceF32,
  kMicrotraceU16,  ///< for decoding only
};

struct MicrotraceChannel {
  const char* name;    ///< R, G, B, then A if there is alpha, then others
  const void* first;   ///< value of the upper left pixel
  std::size_t stride;  ///< bytes from pixel to pixel; rows are contiguous
  MicrotraceNumber number;
};

/// Text for the file's header, if the format supports it.
struct MicrotraceNote {
  const char* name;
  const char* text;
};

/// 8-bit alpha is unassociated, float alpha is premultiplied.
struct MicrotracePicture {
  std::uint32_t width, height;
  std::uint32_t x0, y0;  ///< position of the upper left pixel in the whole picture
  std::uint32_t whole_width, whole_height;  ///< size of the whole picture
  std::int32_t is_color;                    ///< sRGB if 8 bits; otherwise arbitrary numbers
  const MicrotraceChannel* channels;
  std::size_t channel_count;
  const MicrotraceNote* notes;
  std::size_t note_count;
};

/// Receives text or bytes; `context` is the caller's. Never throws.
using MicrotraceSink = void (*)(void* context, const char* bytes, std::size_t size);

/// If pictures with this extension (lower case, no dot) can be written, describes them and returns
/// 1, else returns 0.
using MicrotraceFindFormat = int (*)(const char* extension, MicrotraceFormat* format);

/// Passes the bytes of the picture's file to `out` and returns 0, or passes a reason to `error` and
/// returns 1. The channels must match the format.
using MicrotraceEncode = int (*)(const MicrotracePicture* picture, const char* extension,
                                 MicrotraceSink out, MicrotraceSink error, void* context);

/// The colors of a decoded picture.
struct MicrotraceColors {
  std::uint32_t width, height;
  std::uint32_t channels;   ///< 1: gray, 3: rgb
  MicrotraceNumber number;  ///< U8, U16 or F32
};

struct MicrotraceColorSink {
  void* context;  ///< passed to the functions
  /// Returns the buffer for the samples, row by row from the upper left; null stops decoding.
  /// Called once.
  void* (*begin)(void* context, const MicrotraceColors* colors);
  /// Receives the reason of a failure. Neither function throws.
  void (*complain)(void* context, const char* text);
};

/// Decodes the first picture of a file with this extension (lower case, no dot) without its alpha.
/// Returns 1, or complains and returns 0.
using MicrotraceDecodeColors = int (*)(const void* bytes, std::size_t size, const char* extension,
                                       const MicrotraceColorSink* sink);
}

namespace microtrace::io {

inline constexpr char kFindFormatName[] = "microtrace_find_format_v3";
inline constexpr char kEncodeName[] = "microtrace_encode_v3";
inline constexpr char kDecodeColorsName[] = "microtrace_decode_colors_v1";

}  // namespace microtrace::io
