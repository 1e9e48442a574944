// Compares locations and nearest points of solids with the results of CGAL with exact numbers.

#include "oracle/exact_numbers.hpp"
#include "support/cases/closed_meshes.hpp"
#include "support/cases/solid_cases.hpp"
#include "support/effort.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/queries.hpp>

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

/// Returns the mesh as a CGAL mesh. Nothing if CGAL can't represent it or it violates CGAL's
/// preconditions: it is not manifold, or has a triangle without area.
std::optional<SurfaceMesh> surface_mesh(const Mesh& mesh) {
  SurfaceMesh result;
  std::vector<SurfaceMesh::Vertex_index> vertices;
  for (const Vec3& p : mesh.positions)
    vertices.push_back(result.add_vertex(oracle::point<Kernel>(p)));
  for (const auto& [a, b, c] : mesh.triangles) {
    if (CGAL::collinear(result.point(vertices[a]), result.point(vertices[b]),
                        result.point(vertices[c])))
      return std::nullopt;
    if (result.add_face(vertices[a], vertices[b], vertices[c]) == SurfaceMesh::null_face())
      return std::nullopt;
  }
  return CGAL::is_closed(result) ? std::optional(result) : std::nullopt;
}

Location location_of(CGAL::Bounded_side side) {
  return side == CGAL::ON_BOUNDED_SIDE ? Location::inside
         : side == CGAL::ON_BOUNDARY   ? Location::boundary
                                       : Location::outside;
}

std::vector<SolidCase> cases(Random& random) {
  std::vector<SolidCase> result = solid_cases(random, 2);
  for (const ClosedMesh& closed : closed_meshes()) {
    result.push_back({.name = closed.name,
                      .mesh = closed.mesh,
                      .center = closed.center,
                      .size = 2 * closed.radius});
  }
  return result;
}

/// Calls f(case, CGAL's mesh, solid, points) for each case that CGAL can represent. `share` is
/// this test's share of the points of all tests.
template <class F>
void for_each_case(Random& random, double share, const F& f) {
  std::vector<std::pair<SolidCase, SurfaceMesh>> known;
  for (SolidCase& solid_case : cases(random))
    if (auto mesh = surface_mesh(solid_case.mesh)) known.emplace_back(std::move(solid_case), *mesh);
  ASSERT_GT(known.size(), 60U);
  const int count = oracle::case_count(share) / static_cast<int>(known.size()) + 1;
  for (const auto& [solid_case, mesh] : known) {
    SCOPED_TRACE(solid_case.name);
    Scene scene;
    scene.objects.push_back({.name = "", .shape = solid_case.mesh});
    const Solid solid{PreparedScene(std::move(scene))};
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.push_back(point_about(random, solid_case));
    f(mesh, solid, points);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(SolidOracle, AgreesOnLocations) {
  Random random = oracle::announced_random(71);
  std::size_t count[3] = {0, 0, 0};
  for_each_case(random, 0.02, [&](const SurfaceMesh& mesh, const Solid& solid, const auto& points) {
    const CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel> side_of(mesh);
    std::vector<Location> locations(points.size());
    solid.locate(points, locations);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3& p = points[i];
      ASSERT_EQ(locations[i], location_of(side_of(oracle::point<Kernel>(p))))
          << std::hexfloat << p.x << ' ' << p.y << ' ' << p.z;
      ++count[static_cast<std::size_t>(locations[i])];
    }
  });
  std::cout << count[0] << " points outside, " << count[1] << " on the boundary, " << count[2]
            << " inside agree\n";
  for (const std::size_t c : count) EXPECT_GT(c, 1000U);
}

TEST(SolidOracle, AgreesOnNearestPoints) {
  Random random = oracle::announced_random(72);
  for_each_case(random, 0.005,
                [&](const SurfaceMesh& mesh, const Solid& solid, const auto& points) {
                  Tree tree(CGAL::faces(mesh).begin(), CGAL::faces(mesh).end(), mesh);
                  std::vector<std::optional<NearestPoint>> nearest(points.size());
                  solid.nearest_points(points, nearest);
                  for (std::size_t i = 0; i < points.size(); ++i) {
                    const auto p = oracle::point<Kernel>(points[i]);
                    const Kernel::FT squared = CGAL::squared_distance(p, tree.closest_point(p));
                    ASSERT_TRUE(nearest[i].has_value());
                    const auto face = mesh.halfedge(SurfaceMesh::Face_index(nearest[i]->id));
                    const Kernel::Triangle_3 triangle(mesh.point(mesh.source(face)),
                                                      mesh.point(mesh.target(face)),
                                                      mesh.point(mesh.target(mesh.next(face))));
                    ASSERT_EQ(CGAL::squared_distance(p, triangle), squared) << i;
                    const Kernel::FT distance(nearest[i]->distance), error(0x1p-37);
                    ASSERT_LE(CGAL::abs(distance * distance - squared), error * squared) << i;
                  }
                });
}

}  // namespace
}  // namespace microtrace
