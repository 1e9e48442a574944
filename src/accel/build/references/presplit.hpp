#pragma once
/// Splits large or oblique triangles before the build, because their boxes are mostly empty. Such a
/// triangle gets several references, each with the box of one piece. After T. Karras, T. Aila, Fast
/// parallel construction of high-quality bounding volume hierarchies, 2013, section 6.

#include "accel/build/references/references.hpp"

#include <array>
#include <cstddef>

namespace microtrace::build {

/// Maximum number of items that presplit() adds to `count` items.
[[nodiscard]] constexpr std::size_t most_pieces(std::size_t count) {
  return count * 3 / 10;
}

/// A triangle is large enough to be split if the area of its box is at least this multiple of the
/// mean area that a primitive has of the area of the whole scene's box.
inline constexpr float kLeastSplit = 8;

/// Replaces triangles by references to their pieces. Splits none if all triangles have about the
/// same size. The boxes of a triangle's pieces together contain every point of the triangle.
void presplit(References& references);

/// Cuts the part of a triangle within `box` by an axis-aligned plane. Returns a box for each side
/// of the plane, which contains every real point of this part on that side.
[[nodiscard]] std::array<Box, 2> cut(const Triangle& triangle, const Box& box, int axis,
                                     float plane);

}  // namespace microtrace::build
