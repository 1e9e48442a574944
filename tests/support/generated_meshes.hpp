#pragma once
/// Meshes of any size for tests and benchmarks, with the same bits on every machine. The number of
/// triangles is approximate: at least four fifths of the requested number, and at most six fifths
/// from 1000 on.

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>

namespace microtrace::generated {

/// A closed surface around the origin with a radius of about 1 and many bumps of many triangles
/// each, similar to a scanned object.
[[nodiscard]] Mesh displaced_sphere(std::size_t triangles);

/// A height field over a square with edges of 2 in the xz plane.
[[nodiscard]] Mesh terrain(std::size_t triangles);

/// A hall of 40 x 10 x 20 with two rows of columns: walls, beams and cloths with few large
/// triangles, shafts with long thin ones, and mostly tiny triangles in capitals and busts.
[[nodiscard]] Mesh hall(std::size_t triangles);

/// The mesh rotated so that no face of a hall is axis-aligned and bounding boxes fit badly.
[[nodiscard]] Mesh turned(Mesh mesh);

/// The same rotation of a point or a direction, without rounding.
[[nodiscard]] DVec3 turned(const DVec3& p);

}  // namespace microtrace::generated
