#include "support/cases/closed_meshes.hpp"

#include "support/cases/generated_meshes.hpp"

#include <cmath>

namespace microtrace::adversarial {
namespace {

// Rounds vertices to a grid. Differences and small multiples of grid points are exact, so rays can
// be aimed exactly.
Mesh on_grid(Mesh mesh, float spacing) {
  for (Vec3& p : mesh.positions.edit()) {
    for (int k = 0; k < 3; ++k) p[k] = std::nearbyint(p[k] / spacing) * spacing;
  }
  return mesh;
}

Mesh scaled(Mesh mesh, const Vec3& scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions.edit()) p = p * scale + offset;
  return mesh;
}

// Returns a cube whose faces have n x n cells of two triangles. All vertices are at integers. Each
// face is a coplanar wall, and every axis-aligned ray from an integer point hits vertices or edges.
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

}  // namespace

std::vector<ClosedMesh> closed_meshes() {
  using generated::displaced_sphere;
  return {
      {.name = "octahedron",
       .mesh = on_grid(displaced_sphere(8), 0x1p-12F),
       .center = Vec3(0),
       .radius = 0.3F,
       .spacing = 0x1p-12F},
      {.name = "ball",
       .mesh = on_grid(displaced_sphere(20000), 0x1p-12F),
       .center = Vec3(0),
       .radius = 0.5F,
       .spacing = 0x1p-12F},
      {.name = "cube", .mesh = cube(16), .center = Vec3(8), .radius = 7, .spacing = 1},
      // Has long thin triangles.
      {.name = "needle",
       .mesh = scaled(on_grid(displaced_sphere(5000), 0x1p-10F), {1, 1, 64}, Vec3(0)),
       .center = Vec3(0),
       .radius = 0.5F,
       .spacing = 0x1p-10F},
      // Has a grid with the spacing of float32 numbers at this distance.
      {.name = "far",
       .mesh = scaled(on_grid(displaced_sphere(5000), 0x1p-8F), Vec3(64),
                      Vec3(0x1p21F, -0x1p20F, 0x1p21F)),
       .center = {0x1p21F, -0x1p20F, 0x1p21F},
       .radius = 32,
       .spacing = 0x1p-2F},
  };
}

Ray aimed_exactly(Random& random, const ClosedMesh& closed, const Vec3& o) {
  const std::size_t count = closed.mesh.triangles.size();
  const auto& corners = closed.mesh.triangles[random.bits() % count];
  const int i = random.between(0, 2), step = random.between(0, 15);
  const Vec3 a = closed.mesh.positions[corners[static_cast<std::size_t>(i)]] - o;
  const Vec3 b = closed.mesh.positions[corners[static_cast<std::size_t>(i + 1) % 3]] - o;
  const bool at_corner = random.one_in(2);
  return {.o = o, .t_min = 0, .d = at_corner ? a : float(16 - step) * a + float(step) * b};
}

}  // namespace microtrace::adversarial
