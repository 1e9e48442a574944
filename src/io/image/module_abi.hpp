#pragma once
/// The C interface between the library and its OpenImageIO module. A change of anything here takes
/// a new number in the functions' names, so that an old module is refused instead of misread.

#include <cstddef>
#include <cstdint>

extern "C" {

struct MicrotracePicture {
  std::uint32_t width, height;
  const float* rgb;  ///< linear Rec. 709, row by row from the upper left
};

/// Takes text or bytes; `context` is the caller's. Never throws.
using MicrotraceSink = void (*)(void* context, const char* bytes, std::size_t size);

/// Can pictures be written for this ending (small letters, no dot)? 1 or 0.
using MicrotraceCanEncode = int (*)(const char* ending);

/// Hands the bytes of the picture's file to `out` and returns 0, or hands a reason to `error` and
/// returns 1.
using MicrotraceEncode = int (*)(const MicrotracePicture* picture, const char* ending,
                                 MicrotraceSink out, MicrotraceSink error, void* context);
}

namespace microtrace::io {

inline constexpr char module_file_name[] = "microtrace_openimageio.so";
inline constexpr char can_encode_name[] = "microtrace_can_encode_v1";
inline constexpr char encode_name[] = "microtrace_encode_v1";

}  // namespace microtrace::io
