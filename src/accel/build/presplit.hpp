#pragma once
/// Large or slanting triangles have boxes that are mostly empty. Before the build such a triangle
/// is replaced by several references to it, each with the box of a piece: T. Karras, T. Aila, Fast
/// parallel construction of high-quality bounding volume hierarchies, 2013, section 6.

#include "accel/build/reference.hpp"

#include <array>

namespace microtrace::build {

/// Appends pieces, and shrinks the boxes of the references that they come from. At most 30 % more
/// references; none at all where triangles are of one size. The union of the pieces' boxes holds
/// every point of the triangle.
void presplit(PageVector<Reference>& references, const Primitives& primitives);

/// The two parts of a triangle within a box on either side of a plane across an axis. Each box
/// holds every real point of its part.
[[nodiscard]] std::array<Box, 2> cut(const Triangle& triangle, const Box& box, int axis,
                                     float plane);

}  // namespace microtrace::build
