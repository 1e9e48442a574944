#pragma once
/// Splits large or oblique triangles before the build, because their boxes are mostly empty. Such a
/// triangle is replaced by several references to it, each with the box of a piece: T. Karras, T.
/// Aila, Fast parallel construction of high-quality bounding volume hierarchies, 2013, section 6.

#include "accel/build/references/reference.hpp"

#include <array>

namespace microtrace::build {

/// Appends pieces, and shrinks the boxes of the original references. Adds at most 30 % references;
/// none if all triangles have the same size. The union of the pieces' boxes contains every point of
/// the triangle.
void presplit(PageVector<Reference>& references, const Primitives& primitives);

/// Cuts the part of a triangle within a box by an axis-aligned plane. Each returned box contains
/// every real point of the triangle on its side of the plane.
[[nodiscard]] std::array<Box, 2> cut(const Triangle& triangle, const Box& box, int axis,
                                     float plane);

}  // namespace microtrace::build
