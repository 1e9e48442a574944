#include "accel/few_triangles.hpp"

#include "accel/build/wide/wide_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace {
namespace {

using build::largest_component;

constexpr double kFloatRoundoff = 0x1p-24;  // of float32

void put(const Vec3& v, float (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = v[k];
}

/// Rounds to the range of finite numbers.
float limited_float(double x) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(x, -kMost, kMost));
}

Vec3 vertex(const FewTriangles::Entry& entry, int k) {
  const float(&v)[3] = entry.vertices[k];
  return {v[0], v[1], v[2]};
}

FewTriangles::Box common_box(const FewTriangles::Box& a, const FewTriangles::Box& b) {
  FewTriangles::Box box = a;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = std::min(a.lo[k], b.lo[k]);
    box.hi[k] = std::max(a.hi[k], b.hi[k]);
  }
  return box;
}

/// Returns the axis that a vector is along, or kOblique.
int axis_of(const Vec3& v) {
  for (int k = 0; k < 3; ++k) {
    if (v[k] != 0 && v[(k + 1) % 3] == 0 && v[(k + 2) % 3] == 0) return k;
  }
  return FewTriangles::kOblique;
}

void put_edges(const Vec3& a, const Vec3& b, const Vec3& c, FewTriangles::Facet& facet) {
  Vec3 e1 = b - a, e2 = c - a;
  const int axis1 = axis_of(e1), axis2 = axis_of(e2);
  facet.axis = FewTriangles::kOblique;
  if (axis1 != axis2 && axis1 < 3 && axis2 < 3) {
    facet.axis = 3 - axis1 - axis2;
    if (axis1 != (facet.axis + 1) % 3) std::swap(e1, e2);
  }
  put(a, facet.a);
  put(e1, facet.e1);
  put(e2, facet.e2);
  put(glm::cross(e1, e2), facet.n);
}

FewTriangles::Facet facet_of(const FewTriangles::Entry& entry, int number,
                             const TriangleBlock& block) {
  FewTriangles::Facet facet{};
  put_edges(vertex(entry, 0), vertex(entry, 1), vertex(entry, 2), facet);
  facet.largest_edge = block.largest_edge;
  facet.edge_product = block.edge_product;
  facet.box = entry.box;
  facet.first = number;
  facet.second = -1;
  return facet;
}

/// The corners of two triangles with a common edge (b, c).
struct Quadrilateral {
  Vec3 a, b, c, d;
};

std::optional<Quadrilateral> joined(const FewTriangles::Entry& first,
                                    const FewTriangles::Entry& second) {
  for (int k = 0; k < 3; ++k) {
    const Vec3 b = vertex(first, (k + 1) % 3), c = vertex(first, (k + 2) % 3);
    for (int m = 0; m < 3; ++m) {
      const Vec3 p = vertex(second, (m + 1) % 3), q = vertex(second, (m + 2) % 3);
      if ((b == p && c == q) || (b == q && c == p))
        return Quadrilateral{.a = vertex(first, k), .b = b, .c = c, .d = vertex(second, m)};
    }
  }
  return std::nullopt;
}

/// Makes `facet` the parallelogram of both triangles. Returns false, without effect, if they don't
/// form one.
bool join(const FewTriangles::Entry& first, const FewTriangles::Entry& second, int number,
          double most_growth, FewTriangles::Facet& facet) {
  const std::optional<Quadrilateral> corners = joined(first, second);
  if (!corners) return false;
  const auto& [a, b, c, d] = *corners;
  const double em = std::max(largest_component(b - a), largest_component(c - a));
  const double m = double{largest_component(b - a)} * largest_component(c - a);
  // The distance of d from b + c - a. Float64 rounds it by less than the second term.
  const double off =
      largest_component((DVec3(a) + DVec3(d)) - (DVec3(b) + DVec3(c))) +
      0x1p-50 * std::max({largest_component(a), largest_component(b), largest_component(d)});
  const double more_product = 10 / (15 * 0x1p-24) * em * off;
  if (more_product > most_growth * m) return false;
  put_edges(a, b, c, facet);
  const auto enlarged = [](double x) { return static_cast<float>(x * (1 + 0x1p-20) + 0x1p-126); };
  facet.largest_edge = enlarged(em);
  facet.edge_product = enlarged(m + more_product);
  facet.height_slack = enlarged(6 * m * off);
  facet.box = common_box(first.box, second.box);
  facet.second = number;
  return true;
}

/// Sets the rectangle of a facet with an axis. Returns false if its corners are not exact.
bool put_rectangle(const FewTriangles& few, FewTriangles::Facet& facet) {
  FewTriangles::Rectangle& to = facet.rectangle;
  to.plane = facet.a[facet.axis];
  double diagonal_error = 16 * kFloatRoundoff;
  for (int k = 0; k < 2; ++k) {
    const int axis = (facet.axis + 1 + k) % 3;
    const float low = facet.box.lo[axis], high = facet.box.hi[axis];
    for (const int number : {facet.first, facet.second}) {
      for (int corner = 0; corner < 3 && number >= 0; ++corner) {
        const float at = few.entries[number].vertices[corner][axis];
        if (at != low && at != high) return false;
      }
    }
    const double half = (double{high} - low) / 2, edge = (k == 0 ? facet.e1 : facet.e2)[axis];
    to.middle[k] = static_cast<float>((double{low} + high) / 2);
    // See RectangleTest.
    const double error = 16 * kFloatRoundoff * (half + std::abs(double{to.middle[k]})) + 0x1p-100;
    to.inner[k] = static_cast<float>(half - error);
    to.outer[k] = static_cast<float>(half + error);
    to.per_edge[k] = limited_float(1 / edge);
    diagonal_error += error / half;
  }
  to.diagonal_error = limited_float(diagonal_error);
  return facet.box.lo[facet.axis] == facet.box.hi[facet.axis];
}

FewTriangles::Entry entry_of(const TriangleBlock& block, std::size_t lane) {
  const auto [a, b, c] = build::triangle_in(block, lane);
  FewTriangles::Entry entry{};
  put(a, entry.vertices[0]);
  put(b, entry.vertices[1]);
  put(c, entry.vertices[2]);
  const Vec3 lo = glm::min(a, glm::min(b, c)), hi = glm::max(a, glm::max(b, c));
  put(lo, entry.box.lo);
  put(hi, entry.box.hi);
  entry.plane_axis = -1;
  for (int axis = 0; axis < 3; ++axis) {
    if (lo[axis] != hi[axis]) continue;
    entry.plane_axis = axis;
    entry.plane_at = lo[axis];
  }
  entry.id = block.id[lane];
  return entry;
}

}  // namespace

bool FewTrianglesBuilder::add(std::size_t slot) {
  const TriangleBlock& block = tree_.blocks[slot / kWidth];
  const std::size_t k = slot % kWidth;
  FewTriangles& few = *triangles_;
  const auto known = std::span(few.entries).first(static_cast<std::size_t>(few.count));
  // Large triangles can be in several leaves.
  if (std::ranges::find(known, block.id[k], &FewTriangles::Entry::id) != known.end()) return true;
  if (few.count == FewTriangles::kMost) return false;
  const int number = few.count++;
  FewTriangles::Entry& entry = few.entries[number] = entry_of(block, k);
  entry.slot = static_cast<std::uint32_t>(slot);
  const auto facets = std::span(few.facets).first(facets_);
  const bool is_joined = std::ranges::any_of(facets, [&](FewTriangles::Facet& facet) {
    return facet.second < 0 && join(few.entries[facet.first], entry, number, most_growth_, facet);
  });
  if (!is_joined) few.facets[facets_++] = facet_of(entry, number, block);
  return true;
}

std::unique_ptr<const FewTriangles> FewTrianglesBuilder::finish() && {
  const auto facets = std::span(triangles_->facets).first(facets_);
  for (FewTriangles::Facet& facet : facets) {
    if (facet.axis < FewTriangles::kOblique && !put_rectangle(*triangles_, facet))
      facet.axis = FewTriangles::kOblique;
  }
  std::ranges::stable_sort(facets, {}, &FewTriangles::Facet::axis);
  for (int axis = 0; axis <= FewTriangles::kOblique; ++axis)
    triangles_->ends[axis] = static_cast<int>(
        std::ranges::upper_bound(facets, axis, {}, &FewTriangles::Facet::axis) - facets.begin());
  return std::move(triangles_);
}

std::unique_ptr<const FewTriangles> few_triangles(const Tree& tree, double most_growth) {
  if (tree.blocks.empty() || tree.blocks.size() > FewTriangles::kMost || !tree.others.empty() ||
      !tree.instances.empty())
    return nullptr;
  FewTrianglesBuilder builder(tree, most_growth);
  for (std::size_t slot = 0; slot < tree.blocks.size() * kWidth; ++slot) {
    if (is_used(tree.blocks[slot / kWidth], slot % kWidth) && !builder.add(slot)) return nullptr;
  }
  return std::move(builder).finish();
}

}  // namespace microtrace
