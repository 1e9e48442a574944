#pragma once
/// The C interface between the library and its module around meshoptimizer. A change of anything
/// here takes a new number in the function's name, so that an old module is refused instead of
/// misread.

#include <cstddef>

extern "C" {

enum MicrotraceMeshoptMode {
  microtrace_meshopt_attributes,
  microtrace_meshopt_triangles,
  microtrace_meshopt_indices,
};

struct MicrotraceMeshopt {
  const unsigned char* bytes;
  std::size_t size;
  std::size_t count, stride;  ///< as EXT_meshopt_compression allows them for the mode
  MicrotraceMeshoptMode mode;
};

/// Writes count * stride bytes. Returns 1, or 0 where the bytes are no such data.
using MicrotraceDecodeMeshopt = int (*)(const MicrotraceMeshopt* view, void* destination);
}

namespace microtrace::io {

inline constexpr char meshopt_module_file_name[] = "microtrace_meshopt.so";
inline constexpr char decode_meshopt_name[] = "microtrace_decode_meshopt_v1";

}  // namespace microtrace::io
