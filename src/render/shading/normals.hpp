#pragma once
/// Shading normals.

#include "render/shading/shading.hpp"

#include <microtrace/math.hpp>

namespace microtrace {

/// The front side's, by a normal texture whose x and y are scaled; without texture or tangents the
/// vertices' own.
[[nodiscard]] Vec3 mapped_normal(const ShadingPoint& point, const TextureSlot& slot, float scale);

/// Interpolated normals and those of textures may be such that what they reflect would go below the
/// surface, of normal ng, and be lost: then the nearest, about, on the way to the surface's own
/// that does not. All of unit length.
[[nodiscard]] Vec3 usable_normal(const Vec3& n, const Vec3& ng, const Vec3& wo);

}  // namespace microtrace
