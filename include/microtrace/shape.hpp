#pragma once
/// The shapes that a ray can meet, as plain data in world space. Each is a closed set of points
/// over the reals, defined by the float32 numbers stored here; a shape with a number that is not
/// finite is empty.
///
/// To add one: a struct here and in `Shape`, its hit in src/exact/, its filter there too, its
/// reader in src/io/scene_json/scene.cpp and the JSON schema, a scene in scenes/, an oracle test.

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

/// The infinite plane (p - point) . normal = 0; normal of any length, empty if it is zero.
struct Plane {
  Vec3 point{0};
  Vec3 normal{0, 1, 0};
};

/// The part of the plane through center that lies within radius of it; empty if radius < 0 or
/// normal is zero.
struct Disc {
  Vec3 center{0};
  Vec3 normal{0, 1, 0};
  float radius = 1;
};

/// The convex hull of a, b, c. Collinear corners make a segment, equal corners a point.
struct Triangle {
  Vec3 a{0}, b{0}, c{0};
};

/// a x^2 + b y^2 + c z^2 + d xy + e xz + f yz + g x + h y + i z + j = 0, all ten coefficients as
/// they stand.
struct Quadric {
  float a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, i = 0, j = 0;
};

/// Triangles that share corners. What a vertex carries beside its position is there for all
/// vertices, by their numbers, or for none: then the vector is empty.
struct Mesh {
  std::vector<Vec3> positions;  ///< world space
  /// Indices into positions, each below its size. Seen from the front, corners go anticlockwise.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Vec3> normals{};   ///< world space, on the front side; of unit length or zero
  std::vector<Vec4> tangents{};  ///< world space, unit length; w = 1 or -1: bitangent = w (n x t)
  /// Texture coordinates by the number of their set; a set may be empty. (0, 0) is the corner of an
  /// image where its first pixel lies, v goes down.
  std::vector<std::vector<Vec2>> uv_sets{};
  std::vector<Vec4> colors{};  ///< linear Rec. 709 and alpha; a factor of the material's
  /// Lines from vertex to vertex; points, where both ends are one vertex. They have no area, so no
  /// ray meets them: `render` draws them one pixel wide by widen_segments.
  std::vector<std::array<std::uint32_t, 2>> segments{};
};

using Shape = std::variant<Sphere, Plane, Disc, Triangle, Quadric, Mesh>;

}  // namespace microtrace
