#pragma once
/// Shapes as plain data, in scene coordinates (world space relative to Scene::origin). Each shape
/// is a closed set of real points, defined by the float32 numbers stored here. A shape with a
/// number that is not finite is empty.
///
/// To add a shape, add a struct here and to the variant `Shape`, its exact hit in src/exact, its
/// filter in src/accel/filters, its kernel in src/accel/kernels and src/accel/resolve, its test
/// against frustums in src/accel/frustum, its boxes in src/accel/build, its ray origins in
/// src/accel/spawn, its bounds in src/scene/support.hpp, its surface in
/// src/scene/surface_interaction.cpp, its rules in src/scene/validate/validate.cpp, its reader in
/// src/io/scene_json/shape.cpp, its name in src/scene/shape_name.hpp, its numbers in
/// src/explain/numbers.cpp, its members in docs/scene.schema.json and docs/scene-format.md, its
/// class in python/microtrace and python/src, a scene in scenes, and an oracle test in
/// tests/oracle.

#include <microtrace/array.hpp>
#include <microtrace/export.hpp>
#include <microtrace/math.hpp>
#include <microtrace/placement.hpp>
#include <microtrace/short_vector.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <variant>

namespace microtrace {

/// The surface |p - center| = radius; empty if radius < 0.
struct Sphere {
  Vec3 center{0};
  float radius = 1;
};

/// The infinite plane (p - point) . normal = 0. The normal may have any length; the plane is empty
/// if the normal is zero.
struct Plane {
  Vec3 point{0};
  Vec3 normal{0, 1, 0};
};

/// The points within distance radius of center on the plane through center; empty if radius < 0 or
/// the normal is zero. The normal may have any length.
struct Disc {
  Vec3 center{0};
  Vec3 normal{0, 1, 0};
  float radius = 1;
};

/// The convex hull of a, b and c: a segment if they are collinear, a point if they are equal.
struct Triangle {
  Vec3 a{0}, b{0}, c{0};
};

/// The surface a x^2 + b y^2 + c z^2 + d xy + e xz + f yz + g x + h y + i z + j = 0.
struct Quadric {
  float a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, i = 0, j = 0;
};

struct Mesh;

/// A mesh at a place, which may differ from Mesh::placement. Refers to both.
struct PlacedMesh {
  const Mesh* arrays = nullptr;          ///< null: no mesh
  const Placement* placement = nullptr;  ///< null: the arrays are in scene coordinates

  PlacedMesh() = default;
  PlacedMesh(const Mesh& mesh);  // NOLINT(google-explicit-constructor): placed by Mesh::placement
  PlacedMesh(const Mesh& mesh, const Placement* at) : arrays(&mesh), placement(at) {}
  explicit operator bool() const { return arrays != nullptr; }
  [[nodiscard]] bool is_mirrored() const {
    return placement != nullptr && placement->is_mirrored();
  }

  /// Returns a vertex in scene coordinates.
  [[nodiscard]] Vec3 position(std::size_t vertex) const;
  /// Returns the normal of a vertex in scene coordinates. The mesh must have normals.
  [[nodiscard]] Vec3 normal(std::size_t vertex) const;
  /// Returns the tangent of a vertex in scene coordinates. The mesh must have tangents.
  [[nodiscard]] Vec4 tangent(std::size_t vertex) const;
  /// Returns the indices of a triangle's vertices, counterclockwise as seen from the front.
  [[nodiscard]] std::array<std::uint32_t, 3> corners(std::size_t triangle) const;
};

/// A mesh of indexed triangles. Each vertex attribute has a value for every vertex, or its array is
/// empty. Arrays are made from vectors or borrow the caller's memory, see Array.
///
/// Objects can share the arrays of a mesh and place it differently: copies of arrays share their
/// values, and `placement` transforms the values when they are read. Such an object is called an
/// instance. All results are those of a mesh with transformed arrays, bit for bit. Use position(),
/// normal(), tangent() and corners() to read any mesh. See Objects for millions of instances.
struct Mesh {
  Array<Vec3> positions;  ///< in scene coordinates, or in the mesh's own space if it is placed
  /// Indices into positions. Vertices are counterclockwise as seen from the front.
  Array<std::array<std::uint32_t, 3>> triangles;
  Array<Vec3> normals{};  ///< on the front side; unit length or zero
  /// xyz: unit tangent t; w is 1 or -1: bitangent = w (n x t). A PreparedScene generates them if
  /// the material needs them, as docs/gltf.md describes for glTF assets.
  Array<Vec4> tangents{};
  /// Sets of texture coordinates; a set may be empty. (0, 0) is the upper left corner of the image,
  /// and v points down.
  ShortVector<Array<Vec2>> uv_sets{};
  Array<Vec4> colors{};  ///< linear Rec. 709 and alpha; multiplied with the material
  /// Line segments between vertices, or points if both ends are the same vertex. Segments have no
  /// area, so no ray hits them; render() draws them one pixel wide with widen_segments().
  Array<std::array<std::uint32_t, 2>> segments{};
  /// Transforms positions, normals and tangents, and exchanges two corners of each triangle if it
  /// mirrors; null: the arrays are in scene coordinates. A placed mesh must not have segments.
  std::shared_ptr<const Placement> placement{};

  /// See PlacedMesh.
  [[nodiscard]] Vec3 position(std::size_t vertex) const {
    return PlacedMesh(*this).position(vertex);
  }
  [[nodiscard]] Vec3 normal(std::size_t vertex) const { return PlacedMesh(*this).normal(vertex); }
  [[nodiscard]] Vec4 tangent(std::size_t vertex) const { return PlacedMesh(*this).tangent(vertex); }
  [[nodiscard]] std::array<std::uint32_t, 3> corners(std::size_t triangle) const {
    return PlacedMesh(*this).corners(triangle);
  }
};

inline PlacedMesh::PlacedMesh(const Mesh& mesh) : PlacedMesh(mesh, mesh.placement.get()) {}
inline Vec3 PlacedMesh::position(std::size_t vertex) const {
  const Vec3& p = arrays->positions[vertex];
  return placement != nullptr ? Vec3(placement->point(DVec3(p))) : p;
}
inline Vec3 PlacedMesh::normal(std::size_t vertex) const {
  const Vec3& n = arrays->normals[vertex];
  return placement != nullptr ? Vec3(placement->normal(DVec3(n))) : n;
}
inline Vec4 PlacedMesh::tangent(std::size_t vertex) const {
  const Vec4& t = arrays->tangents[vertex];
  if (placement == nullptr) return t;
  return {Vec3(placement->direction(DVec3(t))), placement->is_mirrored() ? -t.w : t.w};
}
inline std::array<std::uint32_t, 3> PlacedMesh::corners(std::size_t triangle) const {
  std::array<std::uint32_t, 3> result = arrays->triangles[triangle];
  if (is_mirrored()) std::swap(result[1], result[2]);
  return result;
}

/// Returns a copy of a placed mesh with transformed arrays and without a placement. Returns other
/// meshes unchanged.
[[nodiscard]] MICROTRACE_EXPORT Mesh baked(const Mesh& mesh);

using Shape = std::variant<Sphere, Plane, Disc, Triangle, Quadric, Mesh>;

}  // namespace microtrace
