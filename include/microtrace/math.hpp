#pragma once
/// The vector and matrix types, which are GLM's. World space is right-handed with +y up; lengths
/// have no unit.

#include <type_traits>

#include <glm/mat3x2.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace microtrace {

using Vec2 = glm::vec2;      ///< texture coordinates
using Vec3 = glm::vec3;      ///< stored geometry, rays, colors
using Vec4 = glm::vec4;      ///< colors with alpha, tangents
using DVec2 = glm::dvec2;    ///< texture coordinates during computation
using DVec3 = glm::dvec3;    ///< cameras, transforms and intermediate results in float64
using DVec4 = glm::dvec4;    ///< colors with alpha, during computation
using Mat3x2 = glm::mat3x2;  ///< affine maps of the plane; the third column is the translation
using DMat4 = glm::dmat4;    ///< node transforms, column-major as in glTF

// GLM's alignment macros would give these types a different layout than in the compiled library.
static_assert(sizeof(Vec2) == 8 && sizeof(Vec3) == 12 && sizeof(Vec4) == 16 && sizeof(DVec3) == 24,
              "GLM must be used without forced alignment");
static_assert(std::is_trivially_copyable_v<Vec3>, "GLM must be used without GLM_FORCE_CTOR_INIT");

}  // namespace microtrace
