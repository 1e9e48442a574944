#pragma once
/// Vectors: GLM's, in one place. World space is right-handed, +y up; lengths have no unit of their
/// own.

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace microtrace {

using Vec3 = glm::vec3;    ///< stored geometry, rays, colours
using DVec3 = glm::dvec3;  ///< cameras and transforms, before the one rounding to float32
using DMat4 = glm::dmat4;  ///< node transforms, column-major as in glTF

// A program that defines GLM's alignment macros would see other layouts than the library was built
// with.
static_assert(sizeof(Vec3) == 12 && sizeof(DVec3) == 24,
              "GLM must be used without forced alignment");

}  // namespace microtrace
