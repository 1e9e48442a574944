// Checks which triangles the kernels find near a box: all triangles that have a point in the box,
// and few others.

#include "accel/build/tree.hpp"
#include "accel/few_triangles.hpp"
#include "accel/kernels/dispatch.hpp"
#include "accel/large_triangles.hpp"
#include "support/cases/adversarial_rays.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

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
    if (!few_) large_ = large_triangles(tree_);
  }
  [[nodiscard]] bool has_large() const { return large_.triangles != nullptr; }

  /// Returns the triangles that the query finds. Nothing if they are too many.
  std::optional<std::set<PrimitiveId>> near(const Vec3& lo, const Vec3& hi,
                                            const Omitted& omitted = {}) const {
    BoxQueries query{};
    query.size = 1;
    for (int k = 0; k < 3; ++k) query.lo[k][0] = lo[k], query.hi[k][0] = hi[k];
    query.omitted_id[0] = omitted.id;
    query.plane_axis[0] = static_cast<float>(omitted.plane_axis);
    query.plane_at[0] = omitted.plane_at;
    const auto found = search(query, tree());
    if (few_) {  // without traversal, the same triangles are found
      TreeView view = tree();
      view.few = few_.get();
      EXPECT_EQ(found, search(query, view));
    }
    if (has_large()) check_large(found[0], query);
    return found[0];
  }

  /// Returns the triangles that each query finds by traversal.
  std::vector<std::optional<std::set<PrimitiveId>>> search(BoxQueries& queries) const {
    return search(queries, tree());
  }

 private:
  /// Checks that the triangles are also found if large ones are searched without traversal. Of
  /// these, more may be found, because leaves have only parts of their boxes.
  void check_large(const std::optional<std::set<PrimitiveId>>& expected, BoxQueries& query) const {
    TreeView view = tree();
    view.nodes = large_.rest.data();
    view.few = large_.triangles.get();
    view.few_are_all = false;
    const auto found = search(query, view)[0];
    if (!found) return;
    ASSERT_TRUE(expected);
    EXPECT_TRUE(std::ranges::includes(*found, *expected));
    EXPECT_LE(found->size(), expected->size() + static_cast<std::size_t>(large_.triangles->count));
  }

  std::vector<std::optional<std::set<PrimitiveId>>> search(BoxQueries& queries,
                                                           const TreeView& view) const {
    kernels_.touching(view, queries);
    std::vector<std::optional<std::set<PrimitiveId>>> result;
    for (int query = 0; query < queries.size; ++query) {
      auto& found = result.emplace_back();
      if (queries.count[query] < 0) continue;
      found.emplace();
      for (int i = 0; i < queries.count[query]; ++i) {
        const std::uint32_t slot = queries.slots[query][i];
        found->insert(tree_.blocks[slot / kWidth].id[slot % kWidth]);
      }
    }
    return result;
  }

  [[nodiscard]] TreeView tree() const {
    return {.nodes = tree_.nodes.data(),
            .blocks = tree_.blocks.data(),
            .others = tree_.others.data(),
            .root = tree_.root};
  }

  Scene scene_;
  const Kernels& kernels_;
  Tree tree_;
  std::unique_ptr<const FewTriangles> few_;
  LargeTriangles large_;
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

// Small triangles, and large ones that many boxes touch. Some boxes are near each other, so that
// their queries share nodes, some touch too many triangles, and some are empty.
TEST_P(Touching, SeveralQueriesFindTheTrianglesOfSingleOnes) {
  Random random(53);
  Mesh mesh;
  for (int i = 0; i < 2000; ++i) {
    const float size = i % 50 == 0 ? 1.0F : 0x1p-5F;
    const Vec3 a = random.in_cube(1), b = a + random.in_cube(size), c = a + random.in_cube(size);
    append_triangle(mesh, a, b, c);
  }
  const Places places(mesh, *GetParam());
  int some = 0, too_many = 0;
  for (int round = 0; round < 300; ++round) {
    BoxQueries queries{};
    queries.size = random.between(1, kBoxQueries);
    std::vector<std::optional<std::set<PrimitiveId>>> expected;
    const Vec3 middle = random.in_cube(1);
    const float range = random.power_of_two(-6, 0);
    for (int i = 0; i < queries.size; ++i) {
      const Vec3 p = middle + random.in_cube(range);
      const float reach = random.one_in(8) ? -1 : random.power_of_two(-12, -1);
      const Omitted omitted{.id = static_cast<PrimitiveId>(random.between(0, 1999))};
      for (int k = 0; k < 3; ++k) queries.lo[k][i] = p[k] - reach, queries.hi[k][i] = p[k] + reach;
      queries.omitted_id[i] = omitted.id;
      queries.plane_axis[i] = -1;
      expected.push_back(places.near(p - reach, p + reach, omitted));
      some += expected.back() && !expected.back()->empty() ? 1 : 0;
      too_many += expected.back() ? 0 : 1;
      if (reach < 0) {
        ASSERT_EQ(expected.back(), std::set<PrimitiveId>());
      }
    }
    ASSERT_EQ(places.search(queries), expected) << round;
  }
  EXPECT_GT(some, 500);
  EXPECT_GT(too_many, 100);
}

// Thin triangles from a corner to many places, so that their bounding boxes contain the boxes of
// three queries. In each place, the third query overlaps only half of them, so the first two leave
// it there. These subtrees are more than a stack has room for.
TEST_P(Touching, QueriesPartInManySubtrees) {
  constexpr int kPlaces = 34, kTriangles = 2048;
  Random random(54);
  Mesh mesh;
  for (int i = 0; i < kPlaces; ++i) {
    for (int j = 0; j < kPlaces; ++j) {
      for (int k = 0; k < kTriangles; ++k) {
        const Vec3 jitter = 5e-4F / kPlaces * random.in_cube(1);
        const Vec3 tip = Vec3(static_cast<float>(i), static_cast<float>(j), 0.0F) / float{kPlaces} +
                         Vec3(0.05F, 0.05F, k % 2 != 0 ? 0.01F : 0.01F + 0.3F / kPlaces) + jitter;
        append_triangle(mesh, Vec3(-1), tip, tip - Vec3(1e-4F, 0, 1e-6F));
      }
    }
  }
  const Places places(mesh, *GetParam());
  BoxQueries queries{};
  queries.size = 3;
  const float between = 0.01F + 0.15F / kPlaces;
  std::vector<std::optional<std::set<PrimitiveId>>> expected;
  for (int i = 0; i < queries.size; ++i) {
    const Vec3 p(-0.9F, -0.05F, i < 2 ? -0.9F : between), lo = p - 1e-6F, hi = p + 1e-6F;
    for (int k = 0; k < 3; ++k) queries.lo[k][i] = lo[k], queries.hi[k][i] = hi[k];
    queries.omitted_id[i] = kNoPrimitive;
    queries.plane_axis[i] = -1;
    expected.push_back(places.near(lo, hi));
  }
  EXPECT_EQ(places.search(queries), expected);
}

/// Leaves the index of a node that doesn't exist in memory that the next call may use, so that a
/// search that reads uninitialized memory crashes.
[[gnu::noinline]] void leave_invalid_nodes_on_the_stack() {
  std::array<volatile ChildRef, 16384> memory;
  for (volatile ChildRef& ref : memory) ref = child_ref::kMaxNodes - 1;
}

// Queries part in more subtrees than a stack has room for, and have too many results there.
TEST_P(Touching, QueriesInADenseSoup) {
  Random random(55);
  Mesh mesh;
  for (int i = 0; i < 20000; ++i)
    append_triangle(mesh, random.in_cube(1), random.in_cube(1), random.in_cube(1));
  const Places places(mesh, *GetParam());
  int some = 0, too_many = 0;
  for (int round = 0; round < 500; ++round) {
    BoxQueries queries{};
    queries.size = kBoxQueries;
    std::vector<std::optional<std::set<PrimitiveId>>> expected;
    const float reach = random.power_of_two(-16, -5);
    for (int i = 0; i < queries.size; ++i) {
      const Vec3 p = random.in_cube(1), lo = p - reach, hi = p + reach;
      for (int k = 0; k < 3; ++k) queries.lo[k][i] = lo[k], queries.hi[k][i] = hi[k];
      queries.omitted_id[i] = kNoPrimitive;
      queries.plane_axis[i] = -1;
      expected.push_back(places.near(lo, hi));
      (expected.back() ? some : too_many) += 1;
    }
    leave_invalid_nodes_on_the_stack();
    ASSERT_EQ(places.search(queries), expected) << round;
  }
  EXPECT_GT(some, 1000);
  EXPECT_GT(too_many, 1000);
}

// The large triangles of a tree are searched without traversal.
TEST_P(Touching, FindsLargeAndSmallTriangles) {
  Random random(29);
  int with_large = 0;
  for (int round = 0; round < 50; ++round) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
      append_triangle(mesh, random.in_cube(1), random.in_cube(1), random.in_cube(1));
    for (int i = 0; i < 300; ++i) {
      const Vec3 at = Vec3(0.5F) + 0x1p-3F * random.in_cube(1);
      append_triangle(mesh, at, at + 0x1p-6F * random.in_cube(1), at + 0x1p-6F * random.in_cube(1));
    }
    const Places places(mesh, *GetParam());
    with_large += places.has_large() ? 1 : 0;
    for (int query = 0; query < 50; ++query) {
      const Vec3 at = mesh.positions[static_cast<std::size_t>(random.between(0, 923))];
      const auto ids = places.near(at - Vec3(0x1p-10F), at + Vec3(0x1p-10F));
      ASSERT_TRUE(ids && !ids->empty());
    }
  }
  EXPECT_GT(with_large, 25);
}

}  // namespace
}  // namespace microtrace
