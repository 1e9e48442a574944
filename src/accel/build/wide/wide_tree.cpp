#include "accel/build/wide/wide_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace microtrace::build {
namespace {

float squared_length(const Vec3& v) {
  return v.x * v.x + v.y * v.y + v.z * v.z;
}

// Rotates the vertices so that the first one is opposite the longest edge.
Triangle turned(const Triangle& t) {
  const float ab = squared_length(t.b - t.a), bc = squared_length(t.c - t.b),
              ca = squared_length(t.a - t.c);
  if (ca > bc && ca >= ab) return {t.b, t.c, t.a};
  if (ab > bc) return {t.c, t.a, t.b};
  return t;
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

TriangleBlock empty_block() {
  TriangleBlock block{};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < kWidth; ++i) {
    block.a[0][i] = block.a[1][i] = block.a[2][i] = nan;
    block.id[i] = std::numeric_limits<PrimitiveId>::max();
  }
  return block;
}

void put(TriangleBlock& block, std::size_t slot, PrimitiveId id, const Triangle& unturned) {
  const Triangle t = turned(unturned);
  const Vec3 e1 = t.b - t.a, e2 = t.c - t.a;
  for (int axis = 0; axis < 3; ++axis) {
    block.a[axis][slot] = t.a[axis];
    block.b[axis][slot] = t.b[axis];
    block.c[axis][slot] = t.c[axis];
  }
  block.id[slot] = id;
  const float largest1 = largest_component(e1), largest2 = largest_component(e2);
  block.largest_edge = std::max({block.largest_edge, largest1, largest2});
  block.edge_product =
      std::max(block.edge_product, largest1 * largest2 * (1 + 0x1p-22F) + 0x1p-126F);
}

bool have_same_vertices(const TriangleBlock& a, const TriangleBlock& b) {
  return std::memcmp(&a, &b, offsetof(TriangleBlock, largest_edge)) == 0;
}

}  // namespace microtrace::build
