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
  void* values;              ///< room for `points` elements without gaps
};

struct MicrotraceDraco {
  const char* bytes;
  std::size_t size;
  std::size_t triangles, points;  ///< that the bytes must hold
  std::uint32_t* indices;         ///< room for 3 * triangles
  const MicrotraceDracoAttribute* attributes;
  std::size_t attribute_count;
};

/// Takes the reason of a failure; never throws.
using MicrotraceDracoComplain = void (*)(void* context, const char* text);

/// Fills indices and values: 1, or 0 with a reason.
using MicrotraceDecodeDraco = int (*)(const MicrotraceDraco* mesh, MicrotraceDracoComplain complain,
                                      void* context);
}

namespace microtrace::io {

inline constexpr char draco_module_file_name[] = "microtrace_draco.so";
inline constexpr char decode_draco_name[] = "microtrace_decode_draco_v1";

}  // namespace microtrace::io
