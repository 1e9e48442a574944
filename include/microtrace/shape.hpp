#pragma once
/// Shapes as plain data in world space. Each is a closed set of real points, defined by the float32
/// numbers stored here; a shape with a number that is not finite is empty.
///
/// To add one: a struct here and in `Shape`, its exact hit in src/exact, its filter in
/// src/accel/filters, its boxes in src/accel/build, its ray origins in src/accel/spawn, its bounds
/// in src/scene/support.hpp, its surface in src/scene/surface_interaction.cpp, its rules in
/// src/scene/validate/validate.cpp, its reader in src/io/scene_json/shape.cpp, its name in
/// src/io/sidecar/describe_picture.cpp, docs/scene.schema.json and docs/scene-format.md, a scene
/// in scenes, an oracle in tests/oracle.

#include <microtrace/array.hpp>
#include <microtrace/math.hpp>

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

namespace microtrace {

/// The surface |p - center| = radius; empty if radius < 0.
struct Sphere {
  Vec3 center{0};
  float radius = 1;
};

/// The infinite plane (p - point) . normal = 0; normal has any length, and the plane is empty if it
/// is zero.
struct Plane {
  Vec3 point{0};
  Vec3 normal{0, 1, 0};
};

/// The part of the plane through center within radius of it; empty if radius < 0 or normal is zero.
struct Disc {
  Vec3 center{0};
  Vec3 normal{0, 1, 0};
  float radius = 1;
};

/// The convex hull of a, b, c. Collinear vertices give a segment, equal vertices a point.
struct Triangle {
  Vec3 a{0}, b{0}, c{0};
};

/// a x^2 + b y^2 + c z^2 + d xy + e xz + f yz + g x + h y + i z + j = 0.
struct Quadric {
  float a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, i = 0, j = 0;
};

/// Indexed triangles. Each vertex attribute exists either for all vertices or for none; then its
/// array is empty. Arrays are made from vectors, or borrow the caller's memory: see Array.
struct Mesh {
  Array<Vec3> positions;  ///< world space
  /// Indices into positions, each below its size. Vertices are counterclockwise as seen from the
  /// front.
  Array<std::array<std::uint32_t, 3>> triangles;
  Array<Vec3> normals{};   ///< world space, on the front side; unit length or zero
  Array<Vec4> tangents{};  ///< world space, unit length; w = 1 or -1: bitangent = w (n x t)
  /// Sets of texture coordinates; a set may be empty. (0, 0) is the corner of an image at its first
  /// pixel, v points down.
  std::vector<Array<Vec2>> uv_sets{};
  Array<Vec4> colors{};  ///< linear Rec. 709 and alpha; multiplied with the material
  /// Lines between vertices; points if both ends are the same vertex. They have no area, so no ray
  /// hits them: `render` draws them one pixel wide with widen_segments.
  Array<std::array<std::uint32_t, 2>> segments{};
};

using Shape = std::variant<Sphere, Plane, Disc, Triangle, Quadric, Mesh>;

}  // namespace microtrace
