#pragma once
/// Surface properties at many hits, in memory of the caller.

#include <cstddef>
#include <cstdint>

namespace microtrace {

/// Component c of value i is data[i * stride + c * component_stride]. Strides count numbers and may
/// be negative. Null: the values are not computed.
template <class T>
struct OutputArray {
  T* data = nullptr;
  std::ptrdiff_t stride = 1;
  std::ptrdiff_t component_stride = 1;
};

/// One value for each ray, as in SurfaceInteraction: normals are those of the front side, whichever
/// side the ray hits. Positions are in world space. Numbers are rounded to the type of the array.
/// Arrays must not overlap.
struct SurfaceBuffers {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  OutputArray<double> p{};            ///< 3 components; no hit: 0
  OutputArray<float> n{}, ns{};       ///< 3 components; no hit: 0
  OutputArray<float> barycentrics{};  ///< 3 components; 0 unless the shape is a triangle
  OutputArray<float> uv{};            ///< 2 components, of set 0; 0 if there are none
  OutputArray<bool> front{};          ///< no hit: false
  OutputArray<std::uint32_t> object{}, primitive{};  ///< no hit: kNone
};

}  // namespace microtrace
