#pragma once
/// The C interface between the library and its module for Draco. If the interface changes, the
/// number in the function's name must change too. An old module is then rejected instead of called
/// with the wrong arguments.

#include <cstddef>
#include <cstdint>

extern "C" {

struct MicrotraceDracoAttribute {
  std::uint32_t id;          ///< Draco's unique id
  std::uint32_t components;  ///< 1 to 4
  std::uint32_t type;        ///< type of components, an OpenGL constant
  void* values;              ///< receives tightly packed elements for all points
};

struct MicrotraceDraco {
  const char* bytes;
  std::size_t size;
  /// Meshes with more triangles, or with more than 3 points per triangle, are rejected.
  std::size_t most_triangles;
  std::uint32_t* indices;  ///< 3 per triangle
  MicrotraceDracoAttribute* attributes;
  std::size_t attribute_count;
};

/// Called with the number of triangles before decoding. Returns 1, or 0 if decoding would need too
/// much memory. Never throws.
using MicrotraceDracoReserve = int (*)(void* context, std::size_t triangles);

/// Called with the size of the mesh before any data is written. Allocates memory and sets `indices`
/// and all `values`. Returns 1, or 0 if there is too little memory. Never throws.
using MicrotraceDracoPrepare = int (*)(void* context, std::size_t triangles, std::size_t points);

/// Receives the reason for a failure. Never throws.
using MicrotraceDracoComplain = void (*)(void* context, const char* text);

/// Decodes a mesh into `indices` and `values`. Returns 1. If it fails, passes a reason and returns
/// 0.
using MicrotraceDecodeDraco = int (*)(const MicrotraceDraco* mesh, MicrotraceDracoReserve reserve,
                                      MicrotraceDracoPrepare prepare,
                                      MicrotraceDracoComplain complain, void* context);
}

namespace microtrace::io {

inline constexpr char kDracoModuleFileName[] = "microtrace_draco.so";
inline constexpr char kDecodeDracoName[] = "microtrace_decode_draco_v2";

}  // namespace microtrace::io
