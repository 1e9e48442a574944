#include "support/tree_walk.hpp"

#include "accel/build/wide/wide_tree.hpp"
#include "support/ellipsoid_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace microtrace {
namespace {

Bounds box_of_child(const WideNode& node, int i) {
  return {.lo = {node.lo_x[i], node.lo_y[i], node.lo_z[i]},
          .hi = {node.hi_x[i], node.hi_y[i], node.hi_z[i]}};
}

bool is_empty(const Bounds& b) {
  return !(b.lo.x <= b.hi.x && b.lo.y <= b.hi.y && b.lo.z <= b.hi.z);
}

bool holds(const Bounds& b, const Vec3& p) {
  return b.lo.x <= p.x && p.x <= b.hi.x && b.lo.y <= p.y && p.y <= b.hi.y && b.lo.z <= p.z &&
         p.z <= b.hi.z;
}

// Returns true if the box contains p, apart from rounding errors of p.
bool nearly_holds(const Bounds& b, const DVec3& p, const DVec3& slack) {
  return glm::all(glm::lessThanEqual(DVec3(b.lo) - slack, p)) &&
         glm::all(glm::lessThanEqual(p, DVec3(b.hi) + slack));
}

bool holds(const Bounds& b, const Triangle& t) {
  return holds(b, t.a) && holds(b, t.b) && holds(b, t.c);
}

// Checks that the box contains the six extreme points of the sphere.
bool holds(const Bounds& b, const Sphere& s) {
  for (int k = 0; k < 3; ++k) {
    if (!(double{b.lo[k]} <= double{s.center[k]} - s.radius &&
          double{s.center[k]} + s.radius <= double{b.hi[k]}))
      return false;
  }
  return true;
}

// Checks that the box contains the extreme points of the disc, up to rounding.
bool holds(const Bounds& b, const Disc& d) {
  const DVec3 n = glm::normalize(DVec3(d.normal));
  for (int k = 0; k < 3; ++k) {
    const double reach = d.radius * std::sqrt(std::max(0.0, 1 - n[k] * n[k])) * (1 - 0x1p-40);
    const double slack = 0x1p-50 * (std::abs(double{d.center[k]}) + d.radius);
    if (!(double{b.lo[k]} <= double{d.center[k]} - reach + slack &&
          double{d.center[k]} + reach - slack <= double{b.hi[k]}))
      return false;
  }
  return true;
}

bool holds(const Bounds& b, const Quadric& q) {
  return holds_ellipsoid(b, q);
}

bool holds(const Bounds&, const Plane&) {
  return false;
}

double half_area(const Bounds& b) {
  const DVec3 e = DVec3(b.hi) - DVec3(b.lo);
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

}  // namespace

TreeWalk::TreeWalk(const Tree& tree, const Primitives& primitives)
    : tree_(tree),
      primitives_(primitives),
      nodes_(tree.nodes.size()),
      blocks_(tree.blocks.size()),
      others_(tree.others.size()) {
  for (const PrimitiveId id : tree.unbounded) put(id, Place::unbounded);
  visit(tree.root, tree.bounds, 1);
  const auto all = [](const std::vector<bool>& seen) {
    return std::ranges::all_of(seen, std::identity());
  };
  check_pieces();
  expect(all(nodes_) && all(blocks_) && all(others_), "something is never reached");
}

void TreeWalk::expect(bool good, const std::string& what) {
  if (!good && fault_.empty()) fault_ = what;
}

void TreeWalk::put(PrimitiveId id, Place place) {
  if (id >= places_.size()) places_.resize(std::size_t{id} + 1);
  const bool again = places_[id] != Place::nowhere;
  expect(!again || (place == Place::blocks && places_[id] == place),
         "primitive " + std::to_string(id) + " is there twice");
  places_[id] = place;
}

void TreeWalk::check_pieces() {
  constexpr int n = 24;
  for (const auto& [id, boxes] : pieces_) {
    if (whole_.contains(id)) continue;
    const auto corners = primitives_.visit(id, [](const auto& shape) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(shape)>, Triangle>)
        return std::array<DVec3, 3>{shape.a, shape.b, shape.c};
      else
        return std::array<DVec3, 3>{};
    });
    const DVec3 slack =
        1e-14 * (glm::abs(corners[0]) + glm::abs(corners[1]) + glm::abs(corners[2]));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const DVec3 p =
            (corners[0] * double(i) + corners[1] * double(j) + corners[2] * double(n - i - j)) /
            double(n);
        const bool held =
            std::ranges::any_of(boxes, [&](const Bounds& b) { return nearly_holds(b, p, slack); });
        expect(held, "a point of triangle " + std::to_string(id) + " is in no leaf");
      }
    }
  }
}

void TreeWalk::visit(ChildRef ref, const Bounds& box, int depth) {
  const std::uint32_t kind = ref & child_ref::kKind, index = ref & ~child_ref::kKind;
  const std::uint32_t first = index >> 3U, count = (index & 7U) + 1;
  const auto mark = [&](std::vector<bool>& seen, std::size_t i) {
    const bool good = i < seen.size() && !seen[i];
    expect(good, "a wrong or repeated reference " + std::to_string(ref));
    if (good) seen[i] = true;
    return good;
  };
  if (kind == child_ref::kTriangles) {
    for (std::uint32_t i = 0; i < count; ++i) {
      if (mark(blocks_, first + i)) visit_block(tree_.blocks[first + i], box);
    }
  } else if (kind == child_ref::kOthers) {
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!mark(others_, first + i)) continue;
      const PrimitiveId id = tree_.others[first + i];
      put(id, Place::others);
      primitives_.visit(id, [&](const auto& shape) {
        expect(holds(box, shape), "primitive " + std::to_string(id) + " leaves its box");
      });
    }
  } else {
    depth_ = std::max(depth_, depth);
    if (!mark(nodes_, index)) return;
    const WideNode& node = tree_.nodes[index];
    for (int i = 0; i < kWidth; ++i) {
      const Bounds child = box_of_child(node, i);
      if (is_empty(child)) {
        expect(child.lo == Vec3(INFINITY) && child.hi == Vec3(-INFINITY),
               "an unused place isn't empty");
        continue;
      }
      expect(holds(box, child.lo) && holds(box, child.hi), "a child leaves its node's box");
      visit(node.child[i], child, depth + 1);
    }
  }
}

void TreeWalk::visit_block(const TriangleBlock& block, const Bounds& box) {
  float largest = 0;
  for (std::size_t i = 0; i < kWidth; ++i) {
    const Triangle triangle = build::triangle_in(block, i);
    const Vec3 &a = triangle.a, &b = triangle.b, &c = triangle.c;
    const Vec3 e1 = b - a, e2 = c - a;
    if (std::isnan(a.x)) {
      expect(std::isnan(a.y) && std::isnan(a.z), "an unused place has numbers");
      continue;
    }
    put(block.id[i], Place::blocks);
    primitives_.visit(block.id[i], [&](const auto& shape) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(shape)>, Triangle>) {
        const auto is_turned = [&](const Vec3& first, const Vec3& second, const Vec3& third) {
          return a == first && b == second && c == third;
        };
        expect(is_turned(shape.a, shape.b, shape.c) || is_turned(shape.b, shape.c, shape.a) ||
                   is_turned(shape.c, shape.a, shape.b),
               "block and triangle " + std::to_string(block.id[i]) + " differ");
        ++triangle_references_;
        if (!holds(box, shape))
          pieces_[block.id[i]].push_back(box);
        else
          whole_.insert(block.id[i]);
      } else {
        expect(false, "primitive " + std::to_string(block.id[i]) + " is no triangle");
      }
    });
    const auto size = [](const Vec3& v) {
      return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };
    expect(double{size(e1)} * double{size(e2)} <= double{block.edge_product},
           "edge_product is too small");
    for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(e1[k]), std::abs(e2[k])});
  }
  expect(block.largest_edge == largest, "largest_edge is wrong");
}

TreeCost cost_of(const Tree& tree) {
  const double whole = half_area(tree.bounds);
  TreeCost cost{.nodes = 1};
  for (const WideNode& node : tree.nodes) {
    for (int i = 0; i < kWidth; ++i) {
      const Bounds child = box_of_child(node, i);
      if (is_empty(child)) continue;
      const double chance = half_area(child) / whole;
      if ((node.child[i] & child_ref::kKind) == 0)
        cost.nodes += chance;
      else
        cost.blocks += chance * ((node.child[i] & 7U) + 1);
    }
  }
  return cost;
}

namespace {

struct Medians {
  std::vector<Triangle> triangles;
  double whole = 0;
  TreeCost cost;

  void add(std::size_t begin, std::size_t end, int level) {
    Bounds box, centroids;
    const auto centroid = [](const Triangle& t) { return (t.a + t.b + t.c) / 3.0F; };
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = triangles[i];
      box.lo = glm::min(box.lo, glm::min(t.a, glm::min(t.b, t.c)));
      box.hi = glm::max(box.hi, glm::max(t.a, glm::max(t.b, t.c)));
      centroids.lo = glm::min(centroids.lo, centroid(t));
      centroids.hi = glm::max(centroids.hi, centroid(t));
    }
    const double area = half_area(box);
    if (level == 0) whole = area;
    if (end - begin <= kWidth) {
      cost.blocks += area / whole;
      return;
    }
    if (level % 3 == 0) cost.nodes += area / whole;
    const Vec3 e = centroids.hi - centroids.lo;
    const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) {
      return triangles.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(at(begin), at(middle), at(end), [&](const Triangle& x, const Triangle& y) {
      return centroid(x)[axis] < centroid(y)[axis];
    });
    add(begin, middle, level + 1);
    add(middle, end, level + 1);
  }
};

}  // namespace

TreeCost cost_of_object_medians(const Mesh& mesh) {
  Medians medians;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    medians.triangles.push_back(triangle_of(mesh, i));
  medians.add(0, medians.triangles.size(), 0);
  return medians.cost;
}

}  // namespace microtrace
