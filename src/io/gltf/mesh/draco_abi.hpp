#pragma once
/// The C interface between the library and its module around Draco. A change of anything here takes
/// a new number in the function's name, so that an old module is refused instead of misread.

#include <cstddef>
#include <cstdint>

extern "C" {

struct MicrotraceDracoAttribute {
  std::uint32_t id;          ///< Draco's unique id
  std::uint32_t components;  ///< 1 to 4
  std::uint32_t type;        ///< component type, by glTF's numbers
  void* values;              ///< room for the points' elements without gaps
};

struct MicrotraceDraco {
  const char* bytes;
  std::size_t size;
  std::size_t
      most_triangles;  ///< a mesh with more, or with more than 3 points for each, is not decoded
  std::uint32_t* indices;  ///< room for 3 of each triangle
  MicrotraceDracoAttribute* attributes;
  std::size_t attribute_count;
};

/// Told about how many triangles there are before any is decoded: 1, or 0 where that would take too
/// much memory; never throws.
using MicrotraceDracoReserve = int (*)(void* context, std::size_t triangles);

/// Told the size of the mesh before anything is written: makes room for it, sets `indices` and all
/// `values`. 1, or 0 where there is none; never throws.
using MicrotraceDracoPrepare = int (*)(void* context, std::size_t triangles, std::size_t points);

/// Takes the reason of a failure; never throws.
using MicrotraceDracoComplain = void (*)(void* context, const char* text);

/// Fills indices and values: 1, or 0 with a reason.
using MicrotraceDecodeDraco = int (*)(const MicrotraceDraco* mesh, MicrotraceDracoReserve reserve,
                                      MicrotraceDracoPrepare prepare,
                                      MicrotraceDracoComplain complain, void* context);
}

namespace microtrace::io {

inline constexpr char draco_module_file_name[] = "microtrace_draco.so";
inline constexpr char decode_draco_name[] = "microtrace_decode_draco_v2";

}  // namespace microtrace::io
