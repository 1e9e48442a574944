#pragma once
/// Caller-provided buffers for surface properties at many hits.

#include <cstddef>
#include <cstdint>

namespace microtrace {

/// A strided output array: component c of value i is stored in data[i * stride + c *
/// component_stride]. Strides count elements of type T and may be negative. If data is null, the
/// values are not computed.
template <class T>
struct OutputArray {
  T* data = nullptr;
  std::ptrdiff_t stride = 1;
  std::ptrdiff_t component_stride = 1;
};

/// Each array receives one value per ray, as defined in SurfaceInteraction. Normals point to the
/// front side, whichever side the ray hits. Positions are in world space. Numbers are rounded to
/// the type of the array. Arrays must not overlap.
struct SurfaceBuffers {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  OutputArray<double> p{};            ///< 3 components; no hit: 0
  OutputArray<float> n{}, ns{};       ///< 3 components; no hit: 0
  OutputArray<float> barycentrics{};  ///< 3 components; 0 unless the shape is a triangle
  OutputArray<float> uv{};            ///< 2 components, of set 0; 0 if the surface lacks this set
  OutputArray<bool> front{};          ///< no hit: false
  OutputArray<std::uint32_t> object{}, primitive{};  ///< no hit: kNone
};

}  // namespace microtrace
