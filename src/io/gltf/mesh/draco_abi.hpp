#pragma once
/// The C interface between the library and its module for Draco. Any change needs a new number in
/// the function's name, so that an old module is refused instead of misread.

#include <cstddef>
#include <cstdint>

extern "C" {

struct MicrotraceDracoAttribute {
  std::uint32_t id;          ///< Draco's unique id
  std::uint32_t components;  ///< 1 to 4
  std::uint32_t type;        ///< component type as an OpenGL constant
  void* values;              ///< tightly packed elements of all points
};

struct MicrotraceDraco {
  const char* bytes;
  std::size_t size;
  /// A mesh with more triangles, or more than 3 points per triangle, is refused.
  std::size_t most_triangles;
  std::uint32_t* indices;  ///< 3 per triangle
  MicrotraceDracoAttribute* attributes;
  std::size_t attribute_count;
};

/// Called with the number of triangles before decoding. Returns 1, or 0 if they would need too much
/// memory. Never throws.
using MicrotraceDracoReserve = int (*)(void* context, std::size_t triangles);

/// Called with the size of the mesh before anything is written. Allocates memory and sets `indices`
/// and all `values`. Returns 1, or 0 if there is too little memory. Never throws.
using MicrotraceDracoPrepare = int (*)(void* context, std::size_t triangles, std::size_t points);

/// Receives the reason of a failure. Never throws.
using MicrotraceDracoComplain = void (*)(void* context, const char* text);

/// Fills indices and values. Returns 1, or 0 after giving a reason.
using MicrotraceDecodeDraco = int (*)(const MicrotraceDraco* mesh, MicrotraceDracoReserve reserve,
                                      MicrotraceDracoPrepare prepare,
                                      MicrotraceDracoComplain complain, void* context);
}

namespace microtrace::io {

inline constexpr char kDracoModuleFileName[] = "microtrace_draco.so";
inline constexpr char kDecodeDracoName[] = "microtrace_decode_draco_v2";

}  // namespace microtrace::io
