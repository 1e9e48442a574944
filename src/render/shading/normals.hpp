#pragma once
/// Shading normals.

#include "render/shading/shading.hpp"

#include <microtrace/math.hpp>

namespace microtrace {

/// The front side's shading normal from a normal texture whose x and y are scaled; without texture
/// or tangents the interpolated normal.
[[nodiscard]] Vec3 mapped_normal(const ShadingPoint& point, const TextureSlot& slot, float scale);

/// Interpolated and texture normals may reflect wo below the surface with the geometric normal ng.
/// In this case the result is, approximately, the first normal on the way to ng that doesn't. All
/// vectors have unit length.
[[nodiscard]] Vec3 usable_normal(const Vec3& n, const Vec3& ng, const Vec3& wo);

}  // namespace microtrace
