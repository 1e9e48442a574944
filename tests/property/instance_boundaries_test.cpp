// Checks queries near the boundary between the parts of a large triangle that the tree of a shared
// mesh has split. In the scene, the vertices are rounded, so a point of the triangle need not be
// the image of a point in a part's box.

#include "accel/build/instances/mesh_tree.hpp"
#include "accel/build/references/shape_box.hpp"
#include "accel/build/wide/wide_tree.hpp"
#include "accel/spawn/box_clearance.hpp"
#include "accel/spawn/touching.hpp"
#include "support/cases/placed_scenes.hpp"
#include "support/effort.hpp"

#include <cmath>
#include <memory>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// A triangle in the plane z = 0. The plane x = 0 meets its longest edge at the origin.
Mesh triangle_to_split(adversarial::Random& random) {
  const float left = 500 + 500 * std::abs(random.symmetric()),
              right = 500 + 500 * std::abs(random.symmetric());
  Mesh mesh;
  mesh.positions.push_back({-left, -left, 0});
  mesh.positions.push_back({right, right, 0});
  mesh.positions.push_back({right, -left, 0});
  mesh.triangles.push_back({0, 1, 2});
  return mesh;
}

/// Divides the tree into the two parts of the triangle on either side of the plane x = 0.
void split(OwnedMeshTree& owned, const Mesh& mesh) {
  const float lo = mesh.positions[0].x, hi = mesh.positions[1].x;
  // Triangles with the same bounds as the parts.
  const Triangle left{.a = {lo, lo, 0}, .b = {0, 0, 0}, .c = {0, lo, 0}};
  const Triangle right{.a = {0, lo, 0}, .b = {hi, hi, 0}, .c = {hi, lo, 0}};
  Tree& tree = owned.tree;
  tree.nodes.assign(1, build::empty_node());
  build::set_box(tree.nodes[0], 0, build::box_of(left));
  build::set_box(tree.nodes[0], 1, build::box_of(right));
  tree.nodes[0].child[0] = tree.nodes[0].child[1] = child_ref::kTriangles;
  tree.root = owned.view.root = 0;
  owned.view.nodes = tree.nodes.data();
}

TEST(InstanceBoundaries, HaveThePointsOfSplitTriangles) {
  adversarial::Random random = traversal::announced_random(90);
  int between = 0;
  for (int round = 0; round < 1000; ++round) {
    Mesh mesh = triangle_to_split(random);
    const DVec3 factors(1 + random.unit(), 1 + random.unit(), 1);
    mesh.placement = std::make_shared<const Placement>(glm::scale(DMat4(1), factors));
    OwnedMeshTree owned(mesh, {});
    split(owned, mesh);
    const auto box = build::instance_box(owned, mesh);
    ASSERT_TRUE(box);
    Tree scene;
    scene.views = {owned.view};
    scene.instances.push_back(build::make_instance(owned.tree, *mesh.placement, *box));
    scene.root = child_ref::kFirstInstance;

    // A point of the longest edge. If the edge passes above the origin, the point can be left of
    // one part's box and above the other's.
    const DVec3 a(mesh.position(0)), b(mesh.position(1));
    const double slope = (b.y - a.y) / (b.x - a.x), above = a.y - slope * a.x;
    const double x = -std::abs(above) / 4;
    const Vec3 p(x, above + slope * x, 0);
    const Vec3 spacings(spacing(p.x), spacing(p.y), 0);
    between += p.x < 0 && p.y > 0 ? 1 : 0;
    bool is_found = false;
    for_each_touching(scene, {.lo = p - spacings, .hi = p + spacings},
                      [&](PrimitiveId) { is_found = true; });
    ASSERT_TRUE(is_found) << "round " << round;
  }
  EXPECT_GT(between, 300);
}

}  // namespace
}  // namespace microtrace
