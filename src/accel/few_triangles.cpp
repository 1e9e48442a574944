#include "accel/few_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

void put(float (&to)[3], const Vec3& v) {
  for (int k = 0; k < 3; ++k) to[k] = v[k];
}

}  // namespace

std::unique_ptr<const FewTriangles> few_triangles(const Tree& tree) {
  if (tree.blocks.empty() || tree.blocks.size() > FewTriangles::kMost || !tree.others.empty() ||
      !tree.instances.empty())
    return nullptr;
  auto result = std::make_unique<FewTriangles>();
  for (std::size_t slot = 0; slot < tree.blocks.size() * kWidth; ++slot) {
    const TriangleBlock& block = tree.blocks[slot / kWidth];
    const std::size_t k = slot % kWidth;
    if (std::isnan(block.a[0][k])) continue;
    const auto known = std::span(result->entries).first(static_cast<std::size_t>(result->count));
    // Large triangles can be in several leaves.
    if (std::ranges::find(known, block.id[k], &FewTriangles::Entry::id) != known.end()) continue;
    if (result->count == FewTriangles::kMost) return nullptr;
    FewTriangles::Entry& entry = result->entries[result->count++];
    const Vec3 a(block.a[0][k], block.a[1][k], block.a[2][k]);
    const Vec3 b(block.b[0][k], block.b[1][k], block.b[2][k]);
    const Vec3 c(block.c[0][k], block.c[1][k], block.c[2][k]);
    const Vec3 e1 = b - a, e2 = c - a;
    put(entry.vertices[0], a);
    put(entry.vertices[1], b);
    put(entry.vertices[2], c);
    put(entry.e1, e1);
    put(entry.e2, e2);
    put(entry.n, glm::cross(e1, e2));
    const Vec3 lo = glm::min(a, glm::min(b, c)), hi = glm::max(a, glm::max(b, c));
    put(entry.lo, lo);
    put(entry.hi, hi);
    entry.plane_axis = -1;
    for (int axis = 0; axis < 3; ++axis) {
      if (lo[axis] != hi[axis]) continue;
      entry.plane_axis = axis;
      entry.plane_at = lo[axis];
    }
    entry.largest_edge = block.largest_edge;
    entry.edge_product = block.edge_product;
    entry.id = block.id[k];
    entry.slot = static_cast<std::uint32_t>(slot);
  }
  return result;
}

}  // namespace microtrace
