#pragma once
/// The texels of textures. Contains only plain data; see shading_kernels.hpp.

#include <cstdint>

namespace microtrace {

/// The texels of an image in one color encoding.
struct Texels {
  /// The samples of the image, and of its mip maps, which have four linear channels of 16 bits.
  const void* const* levels = nullptr;
  /// The linear values of the image's color and alpha samples.
  const float *color = nullptr, *alpha = nullptr;
  std::uint32_t channels = 4;
  bool is_wide = false;  ///< true if the image's samples have 16 bits
};

/// How texture coordinates select texels: the size of the image, and the sampler.
struct TexelGrid {
  struct Axis {
    std::int32_t size = 1;  ///< number of texels
    bool is_repeated = false, is_mirrored = false;

    bool operator==(const Axis&) const = default;
  };
  Axis x, y;
  std::int32_t last_level = 0;  ///< of the mip maps that the sampler uses
  /// True for nearest instead of bilinear filtering.
  bool is_nearest_magnified = false, is_nearest_minified = false;

  bool operator==(const TexelGrid&) const = default;
};

/// A grid, and the transformation of a mesh's texture coordinates.
struct TexelLayout {
  TexelGrid grid{};
  float grid_from_uv[3][2] = {{1, 0}, {0, 1}, {0, 0}};  ///< columns of a 2 x 3 matrix
  float width_scale = 1;  ///< scale factor of widths; 0 for lookups without a filter

  bool operator==(const TexelLayout&) const = default;
};

}  // namespace microtrace
