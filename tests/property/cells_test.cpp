// Checks the cells of sorted references: a tree whose upper levels split cells is about as good as
// one that splits single references everywhere, in scenes where this is difficult too.

#include "accel/build/binary/binary_tree.hpp"
#include "accel/build/binary/binning.hpp"
#include "accel/build/references/duplicates.hpp"
#include "accel/build/references/presplit.hpp"
#include "accel/build/references/sort.hpp"
#include "accel/build/tree.hpp"
#include "accel/build/wide/collapse.hpp"
#include "support/cases/generated_meshes.hpp"
#include "support/tree_walk.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using build::BinaryNode;
using build::References;

class CellRandom {
 public:
  float number() { return static_cast<float>(bits_()) * 0x1p-32F; }
  float symmetric() { return 2 * number() - 1; }
  Vec3 in_cube() { return {symmetric(), symmetric(), symmetric()}; }
  std::mt19937& bits() { return bits_; }

 private:
  std::mt19937 bits_{11};  // the same sequence everywhere
};

void add(Mesh& mesh, const Triangle& t) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {t.a, t.b, t.c}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

void add(Mesh& mesh, const Mesh& other, float scale, const Vec3& at) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : other.positions) mesh.positions.push_back(scale * p + at);
  for (const auto& [a, b, c] : other.triangles)
    mesh.triangles.push_back({a + first, b + first, c + first});
}

/// Returns triangles of random sizes at random points.
Mesh soup(std::size_t count, const std::function<float(CellRandom&)>& size) {
  CellRandom random;
  Mesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = random.in_cube();
    const float s = size(random);
    add(mesh, {p, p + s * random.in_cube(), p + s * random.in_cube()});
  }
  return mesh;
}

/// Returns a detailed mesh and one triangle far away.
Mesh dense_in_sparse(float distance) {
  Mesh mesh = generated::displaced_sphere(20000);
  const Vec3 far(distance, 0, 0);
  add(mesh, {far, far + Vec3(0, 1, 0), far + Vec3(0, 0, 1)});
  return mesh;
}

Mesh with_triangles_around(Mesh mesh) {
  CellRandom random;
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = 1e4F * random.in_cube();
    add(mesh, {p, p + 1e3F * random.in_cube(), p + 1e3F * random.in_cube()});
  }
  return mesh;
}

/// Returns spheres, each of which is a tiny part of the one before.
Mesh nested() {
  Mesh mesh;
  Vec3 at(0);
  float scale = 1;
  for (int i = 0; i < 4; ++i, scale *= 1e-3F) {
    add(mesh, generated::displaced_sphere(5000), scale, at);
    at += Vec3(scale, 0, 0);
  }
  return mesh;
}

/// Returns groups of close triangles, far from each other.
Mesh clusters(int in_cluster) {
  CellRandom random;
  Mesh mesh;
  for (int i = 0; i < 20000 / in_cluster; ++i) {
    const Vec3 center = random.in_cube();
    for (int k = 0; k < in_cluster; ++k) {
      const Vec3 p = center + 1e-4F * random.in_cube();
      add(mesh, {p, p + 3e-5F * random.in_cube(), p + 3e-5F * random.in_cube()});
    }
  }
  return mesh;
}

Mesh hairs() {
  CellRandom random;
  Mesh mesh;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random.in_cube();
    add(mesh, {p, p + 0.2F * random.in_cube(), p + 5e-4F * random.in_cube()});
  }
  return mesh;
}

/// Returns a grid of triangles with edges of 1000 and 1.
Mesh slivers() {
  Mesh mesh;
  const std::uint32_t n = 100;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t k = 0; k <= n; ++k)
      mesh.positions.push_back({static_cast<float>(1000 * i), static_cast<float>(k), 0});
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t at = i * (n + 1) + k;
      mesh.triangles.push_back({at, at + 1, at + n + 1});
      mesh.triangles.push_back({at + 1, at + n + 2, at + n + 1});
    }
  }
  return mesh;
}

/// Returns triangles whose boxes all have the same center.
Mesh concentric(std::size_t count) {
  CellRandom random;
  Mesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = (1 + random.number()) * Vec3(1, random.symmetric(), random.symmetric());
    add(mesh, {p, -p, Vec3(0)});
  }
  return mesh;
}

Mesh copies(int count, float distance) {
  Mesh mesh;
  for (int i = 0; i < count; ++i)
    add(mesh, generated::displaced_sphere(5000), 1, Vec3(distance * static_cast<float>(i)));
  return mesh;
}

Mesh in_stadium() {
  Mesh mesh;
  add(mesh, generated::hall(10000), 100, Vec3(0));
  add(mesh, generated::displaced_sphere(20000), 0.1F, Vec3(100));
  return mesh;
}

Mesh flat(Mesh mesh) {
  for (Vec3& p : mesh.positions.edit()) p.z = 0;
  return mesh;
}

Scene scene_of_cells(const Mesh& mesh) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = mesh});
  return scene;
}

References sorted(const Primitives& primitives, build::WorkerPool& pool) {
  References references = build::gather(primitives, std::vector<bool>(1));
  build::presplit(references);
  build::sort(references, pool);
  return references;
}

double cost_of(const BinaryNode& node, const build::AreaMeasure& area) {
  if (node.plan().is_leaf())
    return area(node.box()) * build::kBlockCost *
           std::ceil(static_cast<double>(node.weight()) / 16);
  double cost = 0;
  for (const BinaryNode* child : build::WideChildren(node))
    cost += cost_of(*child, area) +
            (child->plan().is_leaf() ? 0 : area(child->box()) * build::kNodeCost);
  return cost;
}

// Returns the expected cost of a ray below the root.
double cost_of(References references, build::WorkerPool& pool) {
  const build::AreaMeasure area(references.box);
  const auto tree = build_binary_tree(std::move(references), build::kMaxBins, pool);
  return cost_of(tree.root, area);
}

struct Case {
  std::string name;
  Mesh mesh;
};

std::vector<Case> difficult_cases() {
  const auto constant = [](float size) { return [=](CellRandom&) { return size; }; };
  return {
      {"a dense mesh and a far triangle", dense_in_sparse(1e3F)},
      {"a dense mesh and a very far triangle", dense_in_sparse(1e6F)},
      {"a dense mesh in a large scene", with_triangles_around(generated::hall(20000))},
      {"a dense mesh in a stadium", in_stadium()},
      {"nested meshes", nested()},
      {"clusters smaller than a cell", clusters(5)},
      {"clusters as large as a cell", clusters(32)},
      {"clusters larger than a cell", clusters(100)},
      {"few large triangles among small ones",
       soup(20000, [](CellRandom& r) { return r.number() < 0.01F ? 0.3F : 0.003F; })},
      {"triangles of all sizes",
       soup(20000,
            [](CellRandom& r) { return std::ldexp(1.0F, -static_cast<int>(r.bits()() % 12)); })},
      {"large triangles", soup(5000, constant(0.5F))},
      {"long thin triangles", hairs()},
      {"slivers", slivers()},
      {"flat triangles", flat(soup(20000, constant(0.01F)))},
      {"equal centroids", concentric(5000)},
      {"close copies", copies(4, 1e-6F)},
      {"a hall", generated::hall(50000)},
      {"a turned hall", generated::turned(generated::hall(50000))}};
}

TEST(Cells, GiveTreesAsGoodAsSingleReferences) {
  build::WorkerPool pool(2);
  for (const auto& [name, mesh] : difficult_cases()) {
    SCOPED_TRACE(name);
    const Scene scene = scene_of_cells(mesh);
    const Primitives primitives(scene);
    References of_cells = sorted(primitives, pool), single = sorted(primitives, pool);
    single.cells.resize(single.items.size() + 1);
    std::iota(single.cells.begin(), single.cells.end(), 0U);
    EXPECT_LT(cost_of(std::move(of_cells), pool), 1.03 * cost_of(std::move(single), pool));
  }
}

TEST(Cells, AreSmallAndContainAllItems) {
  build::WorkerPool pool(2);
  for (const auto& [name, mesh] : difficult_cases()) {
    SCOPED_TRACE(name);
    const Scene scene = scene_of_cells(mesh);
    const Primitives primitives(scene);
    const References references = sorted(primitives, pool);
    std::vector<std::uint32_t> primitives_in(primitives.count()),
        stored_in(references.stored.size());
    for (const build::CodedItem& item : references.items)
      ++(item.is_stored() ? stored_in : primitives_in)[item.number()];
    EXPECT_TRUE(std::ranges::all_of(stored_in, [](std::uint32_t n) { return n == 1; }));
    for (const build::Reference& piece : references.stored) primitives_in[piece.id()] = 1;
    EXPECT_TRUE(std::ranges::all_of(primitives_in, [](std::uint32_t n) { return n == 1; }));
    EXPECT_EQ(references.cells.front(), 0);
    EXPECT_EQ(references.cells.back(), references.items.size());
    for (std::size_t i = 1; i < references.cells.size(); ++i) {
      ASSERT_GT(references.cells[i], references.cells[i - 1]);
      ASSERT_LE(references.cells[i] - references.cells[i - 1], build::kCellSize);
    }
  }
}

TEST(Cells, AreTheSameForAnyNumberOfThreads) {
  build::WorkerPool one(1), several(3);
  for (const auto& [name, mesh] : difficult_cases()) {
    SCOPED_TRACE(name);
    const Scene scene = scene_of_cells(mesh);
    const Primitives primitives(scene);
    const References a = sorted(primitives, one), b = sorted(primitives, several);
    EXPECT_TRUE(
        std::ranges::equal(a.items, b.items, {}, &build::CodedItem::key, &build::CodedItem::key));
    EXPECT_EQ(a.cells, b.cells);
  }
}

TEST(Cells, FindDuplicatesInADetailOfAScene) {
  const Mesh sphere = generated::displaced_sphere(5000);
  Mesh mesh = copies(4, 0);
  add(mesh, {{1e6F, 0, 0}, {1e6F, 1, 0}, {1e6F, 0, 1}});
  std::ranges::shuffle(mesh.triangles.edit(), CellRandom().bits());
  const Scene scene = scene_of_cells(mesh);
  const Tree tree = build_tree(Primitives(scene), {});
  EXPECT_EQ(tree.duplicates.ids().size(), 3 * sphere.triangles.size());
}

TEST(Cells, GiveValidTreesOfDegenerateMeshes) {
  const auto scaled = [](float scale) {
    Mesh mesh;
    add(mesh, generated::displaced_sphere(3000), scale, Vec3(0));
    return mesh;
  };
  Mesh points, same, line;
  for (int i = 0; i < 3000; ++i) {
    const auto x = static_cast<float>(i);
    add(points, {Vec3(x), Vec3(x), Vec3(x)});
    add(same, {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)});
    add(line, {Vec3(x, 0, 0), Vec3(x + 1, 0, 0), Vec3(x, 0, 0)});
  }
  const std::vector<Case> cases{{"empty", Mesh()},
                                {"subnormal", scaled(0x1p-140F)},
                                {"tiny", scaled(0x1p-112F)},
                                {"huge", scaled(0x1p126F)},
                                {"points", points},
                                {"the same triangle", same},
                                {"a line", line},
                                {"equal centroids", concentric(3000)}};
  for (const auto& [name, mesh] : cases) {
    SCOPED_TRACE(name);
    const Scene scene = scene_of_cells(mesh);
    const Primitives primitives(scene);
    for (const bool keeps_duplicates : {false, true}) {
      const Tree tree = build_tree(primitives, {.keeps_duplicates = keeps_duplicates});
      const TreeWalk walk(tree, primitives);
      EXPECT_EQ(walk.fault(), "");
      EXPECT_LE(walk.depth(), kMaxDepth);
      if (!keeps_duplicates) continue;
      for (PrimitiveId id = 0; id < primitives.count(); ++id)
        ASSERT_NE(walk.place(id), Place::nowhere) << id;
    }
  }
}

TEST(Cells, GiveTheSameHitsForAnyOrderOfTriangles) {
  Mesh mesh = dense_in_sparse(1e3F);
  const Scene scene = scene_of_cells(mesh);
  std::ranges::shuffle(mesh.triangles.edit(), CellRandom().bits());
  const Scene shuffled = scene_of_cells(mesh);
  const Bvh bvh(scene), other(shuffled);
  CellRandom random;
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray{.o = 2.0F * random.in_cube(), .d = random.in_cube()};
    const auto a = bvh.intersect(ray), b = other.intersect(ray);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++hits;
    EXPECT_EQ(a->t, b->t);
  }
  EXPECT_GT(hits, 300);
}

}  // namespace
}  // namespace microtrace
