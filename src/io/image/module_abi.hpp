#pragma once
/// The C interface between the library and its modules of image formats: OpenEXR for .exr, and
/// OpenImageIO for all others except PPM and PNG. If the interface changes, the number in the
/// functions' names must change too. An old module is then rejected instead of called with the
/// wrong arguments.

#include <cstddef>
#include <cstdint>

extern "C" {

/// The pixel format of files with a given extension.
struct MicrotraceFormat {
  std::int32_t is_float;      ///< linear float32 if nonzero, else 8 bits
  std::int32_t has_alpha;     ///< nonzero if alpha is stored with red, green and blue
  std::int32_t has_channels;  ///< nonzero if any number of channels with any names and any
                              ///< MicrotraceNumber is stored
  std::uint32_t least_side, most_side;  ///< limits of width and height in pixels
};

/// For MicrotraceFormat::most_side: the format has no limit that a picture can exceed.
inline constexpr std::uint32_t kMicrotraceAnySide = ~0U;

enum MicrotraceNumber : std::int32_t {
  kMicrotraceU8,
  kMicrotraceU32,
  kMicrotraceF32,
  kMicrotraceU16,  ///< for decoding only
};

struct MicrotraceChannel {
  const char* name;    ///< R, G, B, then A if there is alpha, then further channels
  const void* first;   ///< value of the upper left pixel
  std::size_t stride;  ///< bytes between neighboring pixels; rows are contiguous
  MicrotraceNumber number;
};

/// Text for the file's header, if the format supports it.
struct MicrotraceNote {
  const char* name;
  const char* text;
};

/// A picture to encode. Alpha is unassociated if it has 8 bits, and premultiplied if it is float.
struct MicrotracePicture {
  std::uint32_t width, height;
  std::uint32_t x0, y0;  ///< position of the upper left pixel in the whole picture
  std::uint32_t whole_width, whole_height;  ///< size of the whole picture
  std::int32_t is_color;  ///< nonzero: 8-bit samples are sRGB; zero: samples are arbitrary numbers
  const MicrotraceChannel* channels;
  std::size_t channel_count;
  const MicrotraceNote* notes;
  std::size_t note_count;
};

/// Receives text or bytes. `context` belongs to the caller. Never throws.
using MicrotraceSink = void (*)(void* context, const char* bytes, std::size_t size);

/// If the module can write pictures with this extension (lower case, no dot), sets `format` and
/// returns 1. Otherwise returns 0.
using MicrotraceFindFormat = int (*)(const char* extension, MicrotraceFormat* format);

/// Passes the bytes of the picture's file to `out` and returns 0. If memory runs out, returns 2. If
/// it fails otherwise, passes a reason to `error` and returns 1. The channels must match the
/// format.
using MicrotraceEncode = int (*)(const MicrotracePicture* picture, const char* extension,
                                 MicrotraceSink out, MicrotraceSink error, void* context);

/// The colors of a decoded picture.
struct MicrotraceColors {
  std::uint32_t width, height;
  std::uint32_t channels;   ///< 1: gray, 2: gray and alpha, 3: rgb, 4: rgb and alpha, as stored
  MicrotraceNumber number;  ///< U8, U16 or F32
  std::int32_t is_unassociated;  ///< nonzero if colors are not premultiplied by alpha
  std::int32_t has_further;  ///< nonzero if the file has further pictures, such as frames or pages
  /// Where the upper left pixel is in the whole picture, and the size of the whole picture. Files
  /// of some formats store only a part of it, or pixels beyond it.
  std::int32_t x0, y0;
  std::uint32_t whole_width, whole_height;
};

struct MicrotraceColorSink {
  void* context;  ///< passed to the functions
  /// Returns a buffer for the samples, row by row from the upper left. Null stops decoding. Called
  /// once.
  void* (*begin)(void* context, const MicrotraceColors* colors);
  /// Receives the reason for a failure. Neither function throws.
  void (*complain)(void* context, const char* text);
};

/// Decodes the first picture of a file with this extension (lower case, no dot).
/// Returns 1 on success. Otherwise calls complain() and returns 0.
using MicrotraceDecodeColors = int (*)(const void* bytes, std::size_t size, const char* extension,
                                       const MicrotraceColorSink* sink);
}

namespace microtrace::io {

inline constexpr char kFindFormatName[] = "microtrace_find_format_v4";
inline constexpr char kEncodeName[] = "microtrace_encode_v5";
inline constexpr char kDecodeColorsName[] = "microtrace_decode_colors_v4";

}  // namespace microtrace::io
