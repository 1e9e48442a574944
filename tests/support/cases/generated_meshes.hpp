#pragma once
/// Meshes of any size for tests and benchmarks, with the same bits on every machine. The number of
/// triangles is approximate: at least 4/5 of the requested number and, for 1000 triangles or more,
/// at most 6/5 of it.

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>

namespace microtrace::generated {

/// Returns a closed surface around the origin, similar to a scanned object. Its radius is about 1,
/// and each of its many bumps has many triangles.
[[nodiscard]] Mesh displaced_sphere(std::size_t triangles);

/// Returns a height field over a square with edges of 2 in the xz plane.
[[nodiscard]] Mesh terrain(std::size_t triangles);

/// Returns a hall of 40 x 10 x 20 with two rows of columns. Walls, beams and cloths have few large
/// triangles, and shafts have long thin ones. Most triangles are tiny and belong to capitals and
/// busts.
[[nodiscard]] Mesh hall(std::size_t triangles);

/// Rotates the mesh. Afterwards no face of a hall is axis-aligned, and bounding boxes fit badly.
[[nodiscard]] Mesh turned(Mesh mesh);

/// Rotates a point or a direction in the same way, without rounding to float32.
[[nodiscard]] DVec3 turned(const DVec3& p);

}  // namespace microtrace::generated
