#pragma once
/// Meshes of any size for tests and measurements: the same bits on every machine. Each has about as
/// many triangles as asked for: at least a fifth less, at most a fifth more from 1000 on.

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>

namespace microtrace::generated {

/// A closed surface around the origin, of radius about 1, whose bumps cover many triangles:
/// stands for a scanned object.
[[nodiscard]] Mesh displaced_sphere(std::size_t triangles);

/// Heights over a square of edge 2 in the xz plane.
[[nodiscard]] Mesh terrain(std::size_t triangles);

/// A hall of 40 x 10 x 20 with two rows of columns: walls, beams and cloths of few large triangles,
/// shafts of long thin ones, and most triangles tiny, in capitals and busts.
[[nodiscard]] Mesh hall(std::size_t triangles);

/// Turned so that no face of a hall lies along an axis: boxes fit badly.
[[nodiscard]] Mesh turned(Mesh mesh);

/// The same for a point or a direction, not rounded.
[[nodiscard]] DVec3 turned(const DVec3& p);

}  // namespace microtrace::generated
