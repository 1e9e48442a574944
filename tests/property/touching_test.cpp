// Checks which triangles the kernels find near a box: all triangles that have a point in the box,
// and few others.

#include "accel/build/tree.hpp"
#include "accel/few_triangles.hpp"
#include "accel/kernels/dispatch.hpp"
#include "support/cases/adversarial_rays.hpp"

#include <memory>
#include <optional>
#include <set>
#include <string>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

// The parameter is the instruction set.
class Touching : public testing::TestWithParam<const Kernels*> {};

INSTANTIATE_TEST_SUITE_P(Isa, Touching, testing::ValuesIn(kRayKernels.available()),
                         [](const auto& isa) { return std::string(isa.param->name); });

void append_triangle(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {a, b, c}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// The triangles that a query omits.
struct Omitted {
  PrimitiveId id = kNoPrimitive;
  int plane_axis = -1;
  float plane_at = 0;
};

/// A mesh whose triangles are all in blocks.
class Places {
 public:
  Places(const Mesh& mesh, const Kernels& kernels) : scene_{}, kernels_(kernels) {
    scene_.objects.push_back({.name = "", .shape = mesh});
    tree_ = build_tree(Primitives(scene_), {.fast = false, .threads = 1});
    few_ = few_triangles(tree_);
  }

  /// Returns the triangles that the query finds. Nothing if they are too many.
  std::optional<std::set<PrimitiveId>> near(const Vec3& lo, const Vec3& hi,
                                            const Omitted& omitted = {}) const {
    BoxQueries query{};
    query.size = 1;
    for (int k = 0; k < 3; ++k) query.lo[k][0] = lo[k], query.hi[k][0] = hi[k];
    query.omitted_id[0] = omitted.id;
    query.plane_axis[0] = static_cast<float>(omitted.plane_axis);
    query.plane_at[0] = omitted.plane_at;
    const auto found = search(query, nullptr);
    // Without traversal, the same triangles are found.
    if (few_) {
      EXPECT_EQ(found, search(query, few_.get()));
    }
    return found;
  }

 private:
  std::optional<std::set<PrimitiveId>> search(BoxQueries& query, const FewTriangles* few) const {
    kernels_.touching({.nodes = tree_.nodes.data(),
                       .blocks = tree_.blocks.data(),
                       .others = tree_.others.data(),
                       .root = tree_.root,
                       .few = few},
                      query);
    if (query.count[0] < 0) return std::nullopt;
    std::set<PrimitiveId> found;
    for (int i = 0; i < query.count[0]; ++i) {
      const std::uint32_t slot = query.slots[0][i];
      found.insert(tree_.blocks[slot / kWidth].id[slot % kWidth]);
    }
    return found;
  }

  Scene scene_;
  const Kernels& kernels_;
  Tree tree_;
  std::unique_ptr<const FewTriangles> few_;
};

// The edges pass exactly through a point, although its distances from the vertices are rounded.
TEST_P(Touching, FindsTrianglesWithAnEdgeThroughThePoint) {
  Random random(51);
  for (int round = 0; round < 2000; ++round) {
    const Vec3 d = random.on_grid(15);
    if (d == Vec3(0)) continue;
    const auto number = [&] { return static_cast<float>(random.between(0x40000, 0xFFFFF)); };
    const Vec3 p = number() * random.power_of_two(-30, -3) * d;
    Mesh mesh;
    for (int i = 0; i < 24; ++i) {
      const Vec3 a = number() * d, b = -number() * d, c = random.in_cube(0x1p20F);
      if (i % 2 == 0)
        append_triangle(mesh, a, b, c);
      else
        append_triangle(mesh, a, c, b);
    }
    const auto found = Places(mesh, *GetParam()).near(p, p);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), mesh.triangles.size()) << round;
  }
}

// Tests long segments and slivers. Hundreds of their bounding boxes contain the box.
TEST_P(Touching, OmitsLongThinTrianglesBesideTheBox) {
  Random random(52);
  int answered = 0, met = 0;
  for (int round = 0; round < 20; ++round) {
    Mesh mesh;
    for (int i = 0; i < 400; ++i) {
      const Vec3 a = random.on_grid(64), b = random.on_grid(64);
      const Vec3 c = random.one_in(2) ? a : a + random.on_grid(1, 0x1p-8F);
      append_triangle(mesh, a, b, c);
    }
    const Places slots(mesh, *GetParam());
    for (int i = 0; i < 50; ++i) {
      const Triangle own = triangle_of(mesh, static_cast<std::size_t>(random.between(0, 399)));
      const float reach = random.power_of_two(-10, -1);
      const Vec3 p = own.a + (own.b - own.a) * (0.125F * static_cast<float>(random.between(0, 8))) +
                     random.on_grid(2, 0.75F * reach);
      const auto found = slots.near(p - reach, p + reach);
      if (!found) continue;
      ++answered;
      for (PrimitiveId id = 0; id < 400; ++id) {
        const Triangle t = triangle_of(mesh, id);
        for (int k = 0; k <= 8; ++k) {
          const Vec3 q = t.a + (t.b - t.a) * (0.125F * static_cast<float>(k));
          if (glm::any(glm::greaterThan(glm::abs(q - p), Vec3(reach)))) continue;
          ++met;
          ASSERT_TRUE(found->contains(id));
        }
      }
    }
  }
  EXPECT_GT(answered, 900);
  EXPECT_GT(met, 200);
}

// The query must omit one triangle, and the triangles within one plane. It must find triangles with
// only an edge in this plane, and triangles in parallel planes.
TEST_P(Touching, OmitsOneTriangleAndAPlane) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](float along, float i, float j) {
      Vec3 p(0);
      p[axis] = along;
      p[(axis + 1) % 3] = i;
      p[(axis + 2) % 3] = j;
      return p;
    };
    Mesh mesh;
    for (int i = 0; i < 40; ++i) {
      const float along = i % 4 == 0 ? 3 : 0, tip = i % 4 == 1 ? 5.0F : along;
      const auto width = static_cast<float>(1 + i);  // the tree has one of equal triangles
      append_triangle(mesh, at(along, -1, -1), at(along, width, -1), at(tip, 0, 9));
    }
    const auto found = Places(mesh, *GetParam())
                           .near(at(0, -0.25F, -1), at(3, 0.25F, -1),
                                 {.id = 8, .plane_axis = axis, .plane_at = 0});
    ASSERT_TRUE(found);
    for (PrimitiveId id = 0; id < 40; ++id)
      EXPECT_EQ(found->contains(id), id % 4 < 2 && id != 8) << axis << " " << id;
  }
}

}  // namespace
}  // namespace microtrace
