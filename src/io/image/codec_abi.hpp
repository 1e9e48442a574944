#pragma once
/// The C interface between the library and its module of codecs. If the interface changes,
/// the number in the functions' names must change too. An old module is then rejected instead of
/// called with the wrong arguments.

#include <cstddef>
#include <cstdint>

extern "C" {

struct MicrotraceImageHeader {
  std::uint32_t width, height;
  std::uint32_t channels;  ///< 1: gray, 2: gray and alpha, 3: rgb, 4: rgb and alpha
  std::uint32_t depth;     ///< bits per sample, 8 or 16, in native byte order
};

struct MicrotraceImageSink {
  void* context;  ///< passed to the functions
  /// Returns a buffer for the samples, row by row from the upper left. Null stops decoding. Called
  /// once.
  void* (*begin)(void* context, const MicrotraceImageHeader* header);
  /// Receives the reason for a failure, or a warning about a file that was decoded nevertheless.
  /// Neither function throws.
  void (*complain)(void* context, const char* text);
};

/// Decodes a PNG, JPEG, WebP or KTX2 file. Returns 1 on success, else 0. Ignores ICC profiles and
/// gamma.
using MicrotraceDecode = int (*)(const void* bytes, std::size_t size,
                                 const MicrotraceImageSink* sink);

/// The content of a PNG file's tEXt chunk.
struct MicrotracePngText {
  const char* keyword;  ///< 1 to 79 Latin-1 characters
  const char* text;
};

/// A picture, and the callbacks of the encoder. No callback throws.
struct MicrotracePng {
  std::uint32_t width, height;
  std::uint32_t channels;  ///< 1: gray, 3: rgb, 4: rgb and unassociated alpha
  std::uint32_t depth;     ///< bits per sample, 8 or 16, in native byte order
  std::uint32_t is_srgb;   ///< if 0, the file states no color space
  std::uint32_t is_fast;   ///< if not 0, compresses less in a fraction of the time
  const MicrotracePngText* texts;
  std::size_t text_count;
  void* context;  ///< passed to the functions
  /// Returns the samples of row y. Called once per row, from top to bottom.
  const unsigned char* (*row)(void* context, std::uint32_t y);
  /// Receives the next bytes of the file. A result of 0 stops the encoder.
  int (*take)(void* context, const void* bytes, std::size_t size);
  void (*complain)(void* context, const char* text);  ///< receives the reason for a failure
};

/// Writes a PNG file whose bytes depend only on the argument. Returns 1 if all bytes were accepted,
/// else 0.
using MicrotraceEncodePng = int (*)(const MicrotracePng* picture);

/// Compresses `size` bytes to a Zstandard frame of at most `capacity` bytes. Returns its size, or 0
/// if it would be larger.
using MicrotraceCompress = std::size_t (*)(void* to, std::size_t capacity, const void* from,
                                           std::size_t size);

/// Decompresses Zstandard frames of `compressed` bytes. Returns 1 if they hold exactly `size`
/// bytes, else 0.
/// Decompressors of other formats have the same type.
using MicrotraceDecompress = int (*)(void* to, std::size_t size, const void* from,
                                     std::size_t compressed);
}

namespace microtrace::io {

inline constexpr char kCodecModuleFileName[] = "microtrace_codecs.so";
inline constexpr char kDecodeName[] = "microtrace_decode_v1";
inline constexpr char kEncodePngName[] = "microtrace_encode_png_v4";
inline constexpr char kCompressName[] = "microtrace_compress_v1";
inline constexpr char kDecompressName[] = "microtrace_decompress_v1";
inline constexpr char kInflateName[] = "microtrace_inflate_v1";  ///< raw deflate, RFC 1951

}  // namespace microtrace::io
