#pragma once
/// The C interface between the library and its module for meshoptimizer. If the interface changes,
/// the number in the function's name must change too. An old module is then rejected instead of
/// called with the wrong arguments.

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
  std::size_t count, stride;  ///< in the ranges that the extensions allow for the mode
  MicrotraceMeshoptMode mode;
};

/// Writes count * stride bytes. Returns 1, or 0 if the data is invalid.
using MicrotraceDecodeMeshopt = int (*)(const MicrotraceMeshopt* view, void* destination);
}

namespace microtrace::io {

inline constexpr char kMeshoptModuleFileName[] = "microtrace_meshopt.so";
inline constexpr char kDecodeMeshoptName[] = "microtrace_decode_meshopt_v2";

}  // namespace microtrace::io
