#include "accel/build/wide/wide_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace microtrace::build {
namespace {

float squared_length(const Vec3& v) {
  return v.x * v.x + v.y * v.y + v.z * v.z;
}

struct Turned {
  Triangle triangle;
  unsigned first;  // the previous number of the first vertex
};
// Rotates the vertices so that the first one is opposite the longest edge. Has no branches, because
// they would often be mispredicted.
Turned turned(const Triangle& t) {
  const float ab = squared_length(t.b - t.a), bc = squared_length(t.c - t.b),
              ca = squared_length(t.a - t.c);
  const auto is_ca = static_cast<unsigned>(ca > bc) & static_cast<unsigned>(ca >= ab);
  const auto is_ab = static_cast<unsigned>(ab > bc) & (is_ca ^ 1U);
  const unsigned first = is_ca + 2 * is_ab;
  const std::array<Vec3, 5> vertices{t.a, t.b, t.c, t.a, t.b};
  return {{vertices[first], vertices[first + 1], vertices[first + 2]}, first};
}

}  // namespace

WideNode empty_node() {
  WideNode node{};
  const float infinity = std::numeric_limits<float>::infinity();
  for (int i = 0; i < kWidth; ++i) {
    node.lo_x[i] = node.lo_y[i] = node.lo_z[i] = infinity;
    node.hi_x[i] = node.hi_y[i] = node.hi_z[i] = -infinity;
  }
  return node;
}

void set_box(WideNode& node, std::size_t i, const Box& box) {
  node.lo_x[i] = box.lo[0];
  node.lo_y[i] = box.lo[1];
  node.lo_z[i] = box.lo[2];
  node.hi_x[i] = box.hi[0];
  node.hi_y[i] = box.hi[1];
  node.hi_z[i] = box.hi[2];
}

Box union_of_children(const WideNode& node) {
  Box box;
  for (std::size_t i = 0; i < kWidth; ++i) box.include(box_of_child(node, i));
  return box;
}

Bounds bounds_of(const Box& box) {
  return {.lo = {box.lo[0], box.lo[1], box.lo[2]}, .hi = {box.hi[0], box.hi[1], box.hi[2]}};
}

BlockFiller::BlockFiller(TriangleBlock& block) : block_(block) {
  block = {};
  for (auto& axis : block.vertices)
    axis[TriangleBlock::kVertices - 1] = std::numeric_limits<float>::quiet_NaN();
  for (auto& corner : block.corners) std::ranges::fill(corner, TriangleBlock::kVertices - 1);
  std::ranges::fill(block.id, std::numeric_limits<PrimitiveId>::max());
}

bool BlockFiller::add(PrimitiveId id, const Triangle& unturned) {
  if (slots_ == kWidth) return false;
  const auto [t, first] = turned(unturned);
  const std::array<Vec3, 3> vertices{t.a, t.b, t.c};
  std::array<unsigned, 3> corners{};
  unsigned count = vertices_;
  for (std::size_t i = 0; i < 3; ++i) {
    const unsigned known = find(vertices[i]);
    corners[i] = known < vertices_ ? known : count++;
  }
  // If slots remain unused, the last vertex is theirs.
  if (count > (slots_ + 1 == kWidth ? TriangleBlock::kVertices : TriangleBlock::kVertices - 1))
    return false;
  vertices_ = count;
  for (std::size_t i = 0; i < 3; ++i) {
    block_.corners[i][slots_] = static_cast<std::uint8_t>(corners[i]);
    for (int axis = 0; axis < 3; ++axis) block_.vertices[axis][corners[i]] = vertices[i][axis];
  }
  block_.corners[0][slots_] |= static_cast<std::uint8_t>(first * TriangleBlock::kVertices);
  block_.id[slots_++] = id;
  const Vec3 e1 = t.b - t.a, e2 = t.c - t.a;
  const float largest1 = largest_component(e1), largest2 = largest_component(e2);
  block_.largest_edge = std::max({block_.largest_edge, largest1, largest2});
  block_.edge_product =
      std::max(block_.edge_product, largest1 * largest2 * (1 + 0x1p-22F) + 0x1p-126F);
  return true;
}

unsigned BlockFiller::find(const Vec3& vertex) const {
  const auto bits = std::bit_cast<std::array<std::int32_t, 3>>(vertex);
  Int4 bit{1, 2, 4, 8}, found{};  // without a branch, which would be unpredictable
  for (unsigned first = 0; first < TriangleBlock::kVertices; first += 4) {
    Int4 is_here = bit;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Int4 in_block;
      std::memcpy(&in_block, &block_.vertices[axis][first], sizeof in_block);
      is_here &= in_block == bits[axis];
    }
    found |= is_here;
    bit <<= 4;
  }
  // Unused vertices don't count.
  const auto all =
      static_cast<unsigned>(found[0] | found[1] | found[2] | found[3]) | 1U << vertices_;
  return static_cast<unsigned>(std::countr_zero(all));
}

bool have_same_vertices(const TriangleBlock& a, const TriangleBlock& b) {
  return std::memcmp(&a, &b, offsetof(TriangleBlock, largest_edge)) == 0;
}

}  // namespace microtrace::build
