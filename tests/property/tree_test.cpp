// Checks the trees of build_tree: a tree has every primitive that can be hit, every box contains
// its subtree, and the tree is the same for any number of threads.

#include "accel/build/tree.hpp"

#include "accel/build/references/presplit.hpp"
#include "accel/build/references/shape_box.hpp"
#include "accel/build/wide/wide_tree.hpp"
#include "support/cases/generated_meshes.hpp"
#include "support/tree_walk.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Scene scene_with(std::vector<Shape> shapes) {
  Scene scene;
  for (Shape& shape : shapes) scene.objects.push_back({.name = "", .shape = std::move(shape)});
  return scene;
}

class Points {
 public:
  /// Returns a random number in [-1, 1).
  float symmetric() { return static_cast<float>(static_cast<std::int32_t>(bits_())) * 0x1p-31F; }
  Vec3 in_cube() { return {symmetric(), symmetric(), symmetric()}; }
  Triangle triangle(float size) {
    const Vec3 p = in_cube();
    return {p, p + size * in_cube(), p + size * in_cube()};
  }

 private:
  std::mt19937 bits_{7};  // the same sequence everywhere
};

Mesh soup(std::size_t triangles, float size) {
  Points random;
  Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Triangle t = random.triangle(size);
    for (const Vec3& p : {t.a, t.b, t.c}) mesh.positions.push_back(p);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// Builds and walks the tree. Expects each primitive, except duplicates, in the array
// `expected(id)`. Points are an exception too, because they are never in blocks.
template <class Expected>
Tree check(const Scene& scene, Expected expected) {
  const Primitives primitives(scene);
  Tree tree = build_tree(primitives, {.fast = false, .threads = 2});
  const TreeWalk walk(tree, primitives);
  EXPECT_EQ(walk.fault(), "");
  EXPECT_LE(walk.depth(), kMaxDepth);
  std::vector<bool> is_duplicate(primitives.count());
  for (const PrimitiveId id : tree.duplicates.ids()) is_duplicate[id] = true;
  primitives.for_each([&](PrimitiveId id, const auto& shape) {
    Place place = is_duplicate[id] ? Place::nowhere : expected(id);
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>) {
      if (place == Place::blocks && shape.a == shape.b && shape.b == shape.c) place = Place::others;
    }
    if (walk.place(id) != place && !testing::Test::HasFailure())
      ADD_FAILURE() << "primitive " << id << " is in place " << static_cast<int>(walk.place(id))
                    << ", not " << static_cast<int>(place);
  });
  return tree;
}

Tree check(const Scene& scene, Place place) {
  return check(scene, [&](PrimitiveId) { return place; });
}

TEST(Tree, EmptyTreeIsANodeWithoutChildren) {
  const Tree tree = check(scene_with({}), Place::nowhere);
  ASSERT_EQ(tree.nodes.size(), 1);
  EXPECT_EQ(tree.root, 0);
  EXPECT_GT(tree.bounds.lo.x, tree.bounds.hi.x);
}

TEST(Tree, OneBlockIsOneLeaf) {
  const auto expect_blocks = [](const Mesh& mesh, bool is_one) {
    const Tree tree = check(scene_with({mesh}), Place::blocks);
    if (is_one) {
      EXPECT_EQ(tree.root, child_ref::kTriangles);
      EXPECT_EQ(tree.nodes.size(), 0);
    }
    EXPECT_EQ(tree.blocks.size(), is_one ? 1 : 2);
  };
  for (std::size_t n = 1; n <= 9; ++n) {
    SCOPED_TRACE(n);
    expect_blocks(soup(n, 1), n <= 5);
    Mesh pairs = soup(n, 1);  // the triangles 2k and 2k + 1 share an edge
    for (std::uint32_t i = 1; i < n; i += 2) {
      auto& corners = pairs.triangles.edit()[i];
      corners = {corners[0], corners[0] - 1, corners[0] - 2};
    }
    expect_blocks(pairs, n <= 8);
  }
}

TEST(Tree, KeepsTheSignsOfZeros) {
  const float zeros[] = {0.0F, -0.0F};
  Scene scene;
  for (const float x : zeros)
    for (const float y : zeros)
      scene.objects.push_back(
          {.name = "", .shape = Triangle{{x, y, 1}, {1, x, y}, {y, 1, 2 + x + y}}});
  const Primitives primitives(scene);
  const Tree tree = build_tree(primitives, {.keeps_duplicates = true});
  const auto bits = [](const Vec3& v) { return std::bit_cast<std::array<std::uint32_t, 3>>(v); };
  std::size_t found = 0;
  for (const TriangleBlock& block : tree.blocks) {
    for (std::size_t slot = 0; slot < kWidth && is_used(block, slot); ++slot, ++found) {
      const Triangle stored = build::triangle_in(block, slot);
      const Triangle own = *primitives.triangle(block.id[slot]);
      std::vector<std::array<std::uint32_t, 3>> vertices{bits(stored.a), bits(stored.b),
                                                         bits(stored.c)};
      EXPECT_TRUE(std::ranges::is_permutation(vertices,
                                              std::vector{bits(own.a), bits(own.b), bits(own.c)}));
    }
  }
  EXPECT_EQ(found, scene.objects.size());
}

TEST(Tree, HoldsMeshesOfAllSizes) {
  for (const unsigned n : {10U, 17U, 64U, 65U, 1000U, 30000U, 100000U}) {
    check(scene_with({soup(n, 0.01F)}), Place::blocks);
    check(scene_with({generated::displaced_sphere(n)}), Place::blocks);
    check(scene_with({generated::terrain(n)}), Place::blocks);
    check(scene_with({generated::hall(n)}), Place::blocks);
  }
}

TEST(Tree, SplitsObliqueTriangles) {
  const auto triangles = [](const Mesh& mesh) {
    return static_cast<double>(mesh.triangles.size());
  };
  const auto references = [](const Mesh& mesh) {
    const Scene scene = scene_with({mesh});
    const Primitives primitives(scene);
    return static_cast<double>(
        TreeWalk(build_tree(primitives, {}), primitives).triangle_references());
  };
  // Many long needles across a cube, and a cluster of tiny triangles.
  Mesh needles = soup(20000, 0.001F);
  Points random;
  for (std::size_t i = 0; i < 3000; i += 3) needles.positions.edit()[i] = random.in_cube();
  check(scene_with({needles}), Place::blocks);
  EXPECT_GT(references(needles), 1.1 * triangles(needles));
  EXPECT_LE(references(needles), 1.3 * triangles(needles));

  const Mesh hall = generated::turned(generated::hall(50000));
  check(scene_with({hall}), Place::blocks);
  EXPECT_GT(references(hall), 1.01 * triangles(hall));
  const Mesh even = generated::displaced_sphere(50000);
  EXPECT_EQ(references(even), triangles(even));
}

TEST(Tree, SplitBoxesContainBothParts) {
  Points random;
  for (int i = 0; i < 20000; ++i) {
    const float size = std::ldexp(1.0F, i % 60 - 30);
    Triangle t = random.triangle(1);
    for (Vec3* p : {&t.a, &t.b, &t.c}) *p *= size;
    const build::Box whole = build::box_of(t);
    const int axis = i % 3;
    const float share = (random.symmetric() + 1) / 2;
    const float plane = whole.lo[axis] + share * (whole.hi[axis] - whole.lo[axis]);
    const auto parts = build::cut(t, whole, axis, plane);
    EXPECT_LE(parts[0].hi[axis], plane);
    EXPECT_GE(parts[1].lo[axis], plane);
    // Points of the edges must be in the part on their side of the plane.
    const std::array<DVec3, 4> corners{t.a, t.b, t.c, t.a};
    for (std::size_t edge = 0; edge < 3; ++edge) {
      for (const double beside : {-0.1, -1e-7, 1e-7, 0.1}) {
        const DVec3 p = corners[edge], d = corners[edge + 1] - p;
        const double at = (double{plane} - p[axis]) / d[axis] + beside;
        if (!(at >= 0 && at <= 1)) continue;
        const DVec3 q = p + at * d;
        const build::Box& part = parts[q[axis] > double{plane}];
        for (int k = 0; k < 3; ++k) {
          EXPECT_LE(double{part.lo[k]}, q[k] + 1e-15 * size);
          EXPECT_GE(double{part.hi[k]}, q[k] - 1e-15 * size);
        }
      }
    }
  }
}

TEST(Tree, SortsShapes) {
  const float large = 0x1p39F, max = std::numeric_limits<float>::max();
  const Vec3 x(1, 0, 0), y(0, 1, 0);
  const std::vector<std::pair<Shape, Place>> cases = {
      {Sphere{Vec3(1, 2, 3), 2}, Place::others},
      {Sphere{Vec3(1, 2, 3), 0}, Place::others},
      {Sphere{Vec3(1, 2, 3), -1}, Place::nowhere},
      {Sphere{Vec3(kNan, 2, 3), 1}, Place::nowhere},
      {Sphere{Vec3(1, 2, 3), kInfinity}, Place::nowhere},
      {Sphere{Vec3(max, 2, 3), max}, Place::unbounded},
      {Disc{Vec3(1, 2, 3), y, 2}, Place::others},
      {Disc{Vec3(1, 2, 3), Vec3(0), 2}, Place::nowhere},
      {Disc{Vec3(1, 2, 3), y, -2}, Place::nowhere},
      {Disc{Vec3(max, 2, 3), Vec3(0x1p-149F), max}, Place::unbounded},
      {Plane{Vec3(1), y}, Place::unbounded},
      {Plane{Vec3(1), Vec3(0)}, Place::nowhere},
      {Plane{Vec3(kInfinity), y}, Place::nowhere},
      {Quadric{.a = 1, .j = -1}, Place::unbounded},
      {Quadric{.a = 1, .b = 2, .c = 3, .j = -1}, Place::others},
      {Quadric{.a = -1, .b = -2, .c = -3, .d = 1, .j = 1}, Place::others},
      {Quadric{.a = 1, .b = 1, .c = 0x1p-40F, .j = -1}, Place::others},
      {Quadric{.a = 0x1p-60F, .b = 0x1p-60F, .c = 0x1p-60F, .j = -0x1p100F}, Place::others},
      {Quadric{.a = 1, .b = 1, .c = 1}, Place::others},
      {Quadric{.a = 1, .b = 1, .c = 1, .j = 1}, Place::unbounded},  // empty
      {Quadric{.a = 1, .b = 1, .c = -1, .j = -1}, Place::unbounded},
      {Quadric{.a = 1, .b = 1, .j = -1}, Place::unbounded},
      {Quadric{.a = 1, .b = 1, .i = 1}, Place::unbounded},
      {Quadric{.a = 1, .b = 1, .c = 1, .d = 2, .j = -1}, Place::unbounded},
      {Quadric{.a = 0x1p-60F, .b = 0x1p-60F, .c = 0x1p-60F, .g = 0x1p120F}, Place::unbounded},
      {Quadric{.a = max, .b = max, .c = max, .d = -max, .j = -max}, Place::others},
      {Quadric{.a = 1, .j = kNan}, Place::nowhere},
      {Triangle{x, y, Vec3(1)}, Place::blocks},
      {Triangle{x, x, y}, Place::blocks},
      {Triangle{x, x, x}, Place::blocks},
      {Triangle{x, y, Vec3(0x1p38F)}, Place::blocks},
      {Triangle{x, y, Vec3(0, -large, 0)}, Place::others},
      {Triangle{Vec3(-max), Vec3(max), Vec3(-max, max, max)}, Place::others},
      {Triangle{x, y, Vec3(0, kNan, 0)}, Place::nowhere},
      {Triangle{Vec3(-kInfinity, 0, 0), y, x}, Place::nowhere},
      {Mesh{}, Place::nowhere},
      {Mesh{.positions = {x, y, Vec3(0), Vec3(kNan)}, .triangles = {{0, 1, 2}}}, Place::blocks}};
  for (int copies = 1; copies <= 40; copies += 39) {
    std::vector<Shape> shapes;
    std::vector<Place> places;
    for (int copy = 0; copy < copies; ++copy) {
      for (const auto& [shape, place] : cases) {
        shapes.push_back(shape);
        if (primitive_count(shape) != 0) places.push_back(place);
      }
    }
    check(scene_with(shapes), [&](PrimitiveId id) { return places[id]; });
  }
}

TEST(Tree, BoxesOfCurvedShapesAreTight) {
  const auto box = [](const Shape& shape) {
    const Scene scene = scene_with({shape});
    return build_tree(Primitives(scene), {}).bounds;
  };
  const Bounds sphere = box(Sphere{Vec3(1, 2, 3), 0.5F});
  EXPECT_LT(sphere.lo.x, 0.5F);
  EXPECT_FLOAT_EQ(sphere.lo.x, 0.5F);
  EXPECT_GT(sphere.hi.z, 3.5F);
  EXPECT_FLOAT_EQ(sphere.hi.z, 3.5F);
  const Bounds disc = box(Disc{Vec3(0), Vec3(3e30F, 0, 4e30F), 10});
  EXPECT_FLOAT_EQ(disc.hi.x, 8);
  EXPECT_FLOAT_EQ(disc.hi.y, 10);
  EXPECT_FLOAT_EQ(disc.lo.z, -6);
  const Bounds flat = box(Disc{Vec3(0, 1, 0), Vec3(0, 0x1p-149F, 0), 1});
  EXPECT_FLOAT_EQ(flat.lo.y, 1);
  EXPECT_FLOAT_EQ(flat.hi.y, 1);
}

// Adds one or two copies of each triangle, in different orders of the triangles and of their
// vertices.
TEST(Tree, StoresDuplicatesOnce) {
  const Mesh once = soup(20001, 0.01F);
  const auto copies = [&](int count, auto change) {
    Mesh mesh = once;
    for (int copy = 1; copy < count; ++copy) {
      for (auto triangle : once.triangles) {
        change(triangle);
        mesh.triangles.push_back(triangle);
      }
    }
    return mesh;
  };
  const auto duplicates = [&](const Mesh& mesh) {
    const Tree tree = check(scene_with({mesh}), Place::blocks);
    return tree.duplicates.ids().size();
  };
  using Corners = std::array<std::uint32_t, 3>;
  EXPECT_EQ(duplicates(once), 0U);
  EXPECT_EQ(duplicates(copies(2, [](Corners&) {})), 20001U);
  EXPECT_EQ(duplicates(copies(3, [](Corners& t) { std::swap(t[0], t[2]); })), 40002U);
  Mesh shuffled = copies(2, [](Corners& t) { t = {t[1], t[2], t[0]}; });
  std::ranges::shuffle(shuffled.triangles.edit(), std::minstd_rand(1));
  EXPECT_EQ(duplicates(shuffled), 20001U);

  // Duplicates only a few triangles among many. One duplicate differs in the signs of zeros.
  Mesh few = soup(30000, 0.01F);
  few.triangles.push_back(few.triangles[7]);
  EXPECT_EQ(duplicates(few), 1U);
  for (const Vec3& p : std::initializer_list<Vec3>{{0.0F, 1, 0}, {1, -0.0F, 0}, {-0.0F, 0, 1}})
    few.positions.push_back(p);
  for (const Vec3& p : std::initializer_list<Vec3>{{-0.0F, 1, 0}, {1, 0.0F, -0.0F}, {0.0F, 0, 1}})
    few.positions.push_back(p);
  few.triangles.push_back({90000, 90001, 90002});
  few.triangles.push_back({90003, 90004, 90005});
  EXPECT_EQ(duplicates(few), 2U);

  // Tests triangles that are too large for blocks, and coincident spheres.
  const Triangle large{{0, 0x1p40F, 0}, {1, 0, 0}, {0, 0, 1}};
  const Tree tree = check(scene_with({large, Sphere{}, Sphere{}, large}), Place::others);
  EXPECT_EQ(tree.duplicates.ids(), std::vector<PrimitiveId>{3});
}

TEST(Tree, SeparatesTrianglesWithoutArea) {
  Mesh mesh = soup(1000, 0.01F);
  for (std::uint32_t i = 0; i < 1000; i += 2) {
    mesh.triangles.push_back({i, i, i});
    mesh.triangles.push_back({i, i + 1, i});
    mesh.triangles.push_back({i + 1, i, i + 1});
  }
  const Tree tree = check(scene_with({mesh}), Place::blocks);
  EXPECT_EQ(tree.duplicates.ids().size(), 500U);
  EXPECT_EQ(tree.others.size(), 500U);
}

TEST(Tree, HandlesInseparableCentroids) {
  Mesh duplicates{.positions = {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(5)}, .triangles = {}};
  duplicates.triangles.assign(100000, {0, 1, 2});
  EXPECT_EQ(check(scene_with({duplicates}), Place::blocks).blocks.size(), 1U);
  duplicates.triangles.assign(100000, {3, 3, 3});
  EXPECT_EQ(check(scene_with({duplicates}), Place::blocks).others.size(), 1U);

  // Different triangles with equal bounding boxes
  Mesh boxed;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const float t = static_cast<float>(i) * 0x1p-15F;
    for (const Vec3& p : std::initializer_list<Vec3>{{0, t, 0}, {1, 0, 0}, {0.5F, 1, 1}})
      boxed.positions.push_back(p);
    boxed.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_TRUE(check(scene_with({boxed}), Place::blocks).duplicates.ids().empty());

  // Triangles with a common center and different sizes
  Mesh nested;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const auto r = static_cast<float>(i);
    for (const Vec3& p : std::initializer_list<Vec3>{{-r, -r, 0}, {r, r, 0}, {r, -r, 0}})
      nested.positions.push_back(p);
    nested.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  check(scene_with({nested}), Place::blocks);
  check(scene_with(std::vector<Shape>(1000, Sphere{})), Place::others);
}

// The centers are at 2^-i, so every plane between bins splits off only a few triangles.
TEST(Tree, HasBoundedDepth) {
  std::vector<Shape> shapes;
  for (int i = -148; i < 126; ++i) {
    const float x = std::ldexp(1.0F, i);
    for (int copy = 0; copy < 20; ++copy) {
      shapes.emplace_back(Triangle{{x, 0, 0}, {x, x, 0}, {x, 0, x}});
      shapes.emplace_back(Triangle{{0, -x, 0}, {0, -x, 0}, {0, -x, 0}});
    }
  }
  check(scene_with(shapes),
        [](PrimitiveId id) { return id / 40 <= 148 + 38 ? Place::blocks : Place::others; });
}

TEST(Tree, HandlesAnyScale) {
  for (const float scale : {0x1p-149F, 0x1p-140F, 0x1p-100F, 0x1p-60F, 0x1p30F, 0x1p37F}) {
    Mesh mesh = soup(3000, 0.1F);
    for (Vec3& p : mesh.positions.edit()) p *= scale;
    check(scene_with({mesh}), Place::blocks);
    // Adds a triangle of maximum size to the mesh.
    Scene scene = scene_with({mesh, Triangle{Vec3(-0x1p38F), Vec3(0x1p38F), Vec3(0, 0x1p38F, 0)}});
    check(scene, Place::blocks);
  }
  Mesh huge = soup(3000, 0.5F);
  for (Vec3& p : huge.positions.edit()) p *= 0x1p127F;
  check(scene_with({huge}), Place::others);
}

bool same(const Tree& a, const Tree& b) {
  const auto bytes = [](const auto& x, const auto& y) {
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return bytes(a.nodes, b.nodes) && bytes(a.blocks, b.blocks) && a.others == b.others &&
         a.unbounded == b.unbounded && a.root == b.root;
}

TEST(Tree, IsTheSameForAnyNumberOfThreads) {
  // All but the last triangle are a small part of the scene.
  Scene scene = scene_with({generated::displaced_sphere(80000), generated::hall(60000), Plane{},
                            Triangle{{1e6F, 0, 0}, {1e6F, 1, 0}, {1e6F, 0, 1}}});
  for (int i = 0; i < 1000; ++i)
    scene.objects.push_back(
        {.name = "", .shape = Sphere{Vec3(0.01F * static_cast<float>(i)), 0.1F}});
  const Primitives primitives(scene);
  for (const bool fast : {false, true}) {
    const Tree one = build_tree(primitives, {.fast = fast, .threads = 1});
    for (const unsigned threads : {1U, 2U, 3U, 8U})
      EXPECT_TRUE(same(one, build_tree(primitives, {.fast = fast, .threads = threads})));
  }
}

TEST(Tree, IsBetterThanOneOfObjectMedians) {
  const std::vector<std::pair<Mesh, double>> cases = {
      {generated::displaced_sphere(50000), 0.9},
      {generated::terrain(50000), 0.9},
      {generated::hall(50000), 0.5},
      {generated::turned(generated::hall(50000)), 0.3},
      {soup(50000, 0.02F), 1}};
  for (const auto& [mesh, most] : cases) {
    const Scene scene = scene_with({mesh});
    const Primitives primitives(scene);
    const TreeCost cost = cost_of(build_tree(primitives, {}));
    const TreeCost fast = cost_of(build_tree(primitives, {.fast = true}));
    const TreeCost median = cost_of_object_medians(mesh);
    EXPECT_LT(cost.total(), most * median.total());
    EXPECT_LT(fast.total(), median.total());
  }
}

TEST(Tree, IsSmall) {
  for (const Mesh& mesh :
       {generated::displaced_sphere(200000), generated::terrain(200000), generated::hall(200000)}) {
    const auto triangles = static_cast<double>(mesh.triangles.size());
    const Scene scene = scene_with({mesh});
    const Tree tree = build_tree(Primitives(scene), {});
    const double bytes = static_cast<double>(tree.nodes.size() * sizeof(WideNode) +
                                             tree.blocks.size() * sizeof(TriangleBlock));
    EXPECT_LT(bytes / triangles, 48);
  }
}

}  // namespace
}  // namespace microtrace
