// No ray leaves a closed mesh from within, not even through a corner or along an edge.

#include "accel/kernels/dispatch.hpp"
#include "support/effort.hpp"
#include "support/generated_meshes.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

struct ClosedMesh {
  const char* name;
  Mesh mesh;
  Vec3 centre;    ///< within
  float radius;   ///< of a ball within, about it
  float spacing;  ///< of the grid on which all corners are
};

// Differences and small multiples of grid points are exact, so rays can be aimed exactly.
Mesh on_grid(Mesh mesh, float spacing) {
  for (Vec3& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) p[k] = std::nearbyint(p[k] / spacing) * spacing;
  }
  return mesh;
}

Mesh scaled(Mesh mesh, const Vec3& scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) p = p * scale + offset;
  return mesh;
}

// A cube whose faces have n x n cells of two triangles, all corners on whole numbers: walls within
// one plane, and every ray along an axis meets corners or edges.
Mesh cube(int n) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, n}) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      const auto row = static_cast<std::uint32_t>(n) + 1;
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          Vec3 p{0};
          p[axis] = static_cast<float>(side);
          p[(axis + 1) % 3] = static_cast<float>(i);
          p[(axis + 2) % 3] = static_cast<float>(j);
          mesh.positions.push_back(p);
        }
      }
      for (std::uint32_t j = 0; j + 1 < row; ++j) {
        for (std::uint32_t i = 0; i + 1 < row; ++i) {
          const std::uint32_t a = first + j * row + i;
          mesh.triangles.push_back({a, a + 1, a + row});
          mesh.triangles.push_back({a + 1, a + row + 1, a + row});
        }
      }
    }
  }
  return mesh;
}

std::vector<ClosedMesh> closed_meshes() {
  using generated::displaced_sphere;
  return {
      {.name = "octahedron",
       .mesh = on_grid(displaced_sphere(8), 0x1p-12F),
       .centre = Vec3(0),
       .radius = 0.3F,
       .spacing = 0x1p-12F},
      {.name = "ball",
       .mesh = on_grid(displaced_sphere(20000), 0x1p-12F),
       .centre = Vec3(0),
       .radius = 0.5F,
       .spacing = 0x1p-12F},
      {.name = "cube", .mesh = cube(16), .centre = Vec3(8), .radius = 7, .spacing = 1},
      // Long thin triangles.
      {.name = "needle",
       .mesh = scaled(on_grid(displaced_sphere(5000), 0x1p-10F), {1, 1, 64}, Vec3(0)),
       .centre = Vec3(0),
       .radius = 0.5F,
       .spacing = 0x1p-10F},
      // The grid is the spacing of float32s there.
      {.name = "far",
       .mesh = scaled(on_grid(displaced_sphere(5000), 0x1p-8F), Vec3(64),
                      Vec3(0x1p21F, -0x1p20F, 0x1p21F)),
       .centre = {0x1p21F, -0x1p20F, 0x1p21F},
       .radius = 32,
       .spacing = 0x1p-2F},
  };
}

// Exactly at a corner, or at one of the fifteen points that cut an edge into sixteen parts.
Ray aimed(Random& random, const ClosedMesh& closed, const Vec3& o) {
  const std::size_t count = closed.mesh.triangles.size();
  const auto& corners = closed.mesh.triangles[random.bits() % count];
  const int i = random.between(0, 2), step = random.between(0, 15);
  const Vec3 a = closed.mesh.positions[corners[static_cast<std::size_t>(i)]] - o;
  const Vec3 b = closed.mesh.positions[corners[static_cast<std::size_t>(i + 1) % 3]] - o;
  const bool at_corner = random.one_in(2);
  return {.o = o, .t_min = 0, .d = at_corner ? a : float(16 - step) * a + float(step) * b};
}

class Leak : public testing::TestWithParam<std::size_t> {
 protected:
  void TearDown() override { unsetenv("MICROTRACE_ISA"); }
};

INSTANTIATE_TEST_SUITE_P(Meshes, Leak, testing::Range<std::size_t>(0, 5),
                         [](const auto& i) { return std::string(closed_meshes()[i.param].name); });

// A fifth of the rays for each mesh; each ray alone, in a tile and in a stream, the kernels taking
// turns.
TEST_P(Leak, NoRayFromWithinLeavesThroughCornersOrEdges) {
  const ClosedMesh closed = closed_meshes()[GetParam()];
  Scene scene;
  scene.objects.push_back({.name = "", .shape = closed.mesh});
  std::vector<Bvh> trees;
  for (const Kernels* kernels : available_kernels()) {
    setenv("MICROTRACE_ISA", kernels->name, 1);
    trees.emplace_back(scene);
  }
  Random random = traversal::announced_random(30 + GetParam());
  constexpr std::size_t kTile = 64, kBatch = 32 * kTile;
  const auto steps = static_cast<int>(closed.radius / 2 / closed.spacing);
  std::vector<Ray> rays(kBatch), apart(kBatch);
  std::vector<std::optional<Hit>> hits(kBatch);
  const auto occluded = std::make_unique<bool[]>(kBatch);
  const auto check_hits = [&] {
    for (const auto& hit : hits) {
      ASSERT_TRUE(hit.has_value());
      ASSERT_LE(hit->t, 1);
    }
  };
  std::size_t turn = 0;
  const auto next_tree = [&]() -> const Bvh& { return trees[turn++ % trees.size()]; };
  const std::size_t batches = traversal::ray_count(0.2) / kBatch + 1;
  for (std::size_t batch = 0; batch < batches && !HasFatalFailure(); ++batch) {
    Vec3 o{0};
    for (std::size_t i = 0; i < kBatch; ++i) {
      if (i % kTile == 0) o = closed.centre + random.on_grid(steps, closed.spacing);
      rays[i] = aimed(random, closed, o);
    }
    const Bvh& singly = next_tree();
    for (std::size_t i = 0; i < kBatch; ++i) hits[i] = singly.intersect(rays[i]);
    check_hits();
    next_tree().intersect(rays, hits);
    check_hits();
    for (std::size_t i = 0; i < kBatch; ++i) apart[i] = rays[i % 32 * kTile + i / 32];
    const Bvh& stream = next_tree();
    stream.intersect(apart, hits);
    check_hits();
    if (batch % 4 == 0) {
      stream.occluded(apart, std::span(occluded.get(), kBatch));
      ASSERT_TRUE(std::all_of(occluded.get(), occluded.get() + kBatch, [](bool b) { return b; }));
    }
    ++turn;  // so that each kernel takes each call
  }
}

}  // namespace
}  // namespace microtrace
