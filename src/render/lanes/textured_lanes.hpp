#pragma once
/// Input and output of the kernel for textured surfaces. Contains only plain data; see
/// shading_kernels.hpp.

#include "render/lanes/surface_lanes.hpp"
#include "render/lanes/texels.hpp"

namespace microtrace {

/// The values of textures that most materials have.
enum class TexelValue { base_color, metallic_roughness, normal, emission, alpha, count };

/// A surface whose base color, metalness, roughness, normal and emission may have textures.
struct TexturedSurface {
  static constexpr int kValues = static_cast<int>(TexelValue::count);

  struct Read {
    Texels texels{};
    int layout = 0;
    int value = 0;  ///< the TexelValue that is read
  };
  int layout_count = 0, read_count = 0;
  TexelLayout layouts[kValues]{};
  Read reads[kValues]{};
  float base_color[4] = {1, 1, 1, 1}, emission[3] = {0, 0, 0};
  float metallic = 1, roughness = 1, normal_scale = 1;
  float covering_alpha = 0;  ///< the alpha from which the surface is opaque
};

struct alignas(64) TexturedLanes {
  LaneFloats color[4];     ///< vertex colors
  LaneFloats least_alpha;  ///< the alpha from which the surface is not passed
  // The kernel sets the members below.
  LaneFloats values[TexturedSurface::kValues][4];  ///< 1 for textures that a material lacks
  std::uint32_t covers;  ///< set of lanes whose alpha is at least least_alpha
  std::uint32_t opaque;  ///< set of these lanes whose surface doesn't emit light
};

}  // namespace microtrace
