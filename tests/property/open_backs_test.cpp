// Compares queries of camera rays that pass through the backs of triangles with Bvh::intersect and
// Bvh::next, ray by ray, for every instruction set of the machine.

#include "accel/intersect_fronts.hpp"
#include "accel/kernels/dispatch.hpp"
#include "accel/ray_tracer.hpp"
#include "accel/resolve/open_side.hpp"
#include "render/shading/primitive_set.hpp"
#include "support/cases/adversarial_scenes.hpp"
#include "support/cases/placed_scenes.hpp"

#include <microtrace/bvh.hpp>

#include <cstdlib>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

// The parameter is the instruction set.
class OpenBacks : public testing::TestWithParam<const Kernels*> {
 protected:
  void SetUp() override { setenv("MICROTRACE_ISA", GetParam()->name, 1); }
  void TearDown() override { unsetenv("MICROTRACE_ISA"); }
};

INSTANTIATE_TEST_SUITE_P(Isa, OpenBacks, testing::ValuesIn(kRayKernels.available()),
                         [](const auto& isa) { return std::string(isa.param->name); });

/// What a test has seen.
struct Seen {
  std::size_t passed = 0;  ///< rays that hit something beyond an open back
  std::size_t missed = 0;  ///< rays that hit only open backs
  std::size_t fronts = 0;  ///< rays that hit the front of an open triangle first
};

/// Compares rays through a scene whose triangles in `open_triangles` have open backs.
void check_rays(const Scene& scene, BitPages open_triangles, const std::vector<Ray>& rays,
                Seen& seen) {
  const Bvh bvh(scene);
  RayTracer tracer;
  tracer.begin(bvh);
  const OpenSide open{.triangles = open_triangles, .is_back = true};
  std::vector<std::optional<Hit>> hits(rays.size());
  intersect_fronts(bvh, rays, open_triangles, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto is_open = [&](PrimitiveId id) {
      return meets_open_side(bvh.primitives(), open, rays[i], id);
    };
    const std::optional<Hit> first = bvh.intersect(rays[i]);
    std::optional<Hit> expected = first, found = hits[i];
    while (expected && is_open(expected->id)) expected = bvh.next(rays[i], *expected);
    // Where triangles coincide, the query may find open backs.
    while (!tracer.knows_sides() && found && is_open(found->id)) found = bvh.next(rays[i], *found);
    ASSERT_EQ(found.has_value(), expected.has_value()) << "ray " << i;
    if (!first) continue;
    if (!expected) {
      ++seen.missed;
      continue;
    }
    ASSERT_EQ(found->id, expected->id) << "ray " << i;
    ASSERT_EQ(found->t, expected->t) << "ray " << i;
    if (expected->id != first->id)
      ++seen.passed;
    else
      seen.fronts += is_in(open_triangles, first->id) ? 1 : 0;
  }
}

/// Compares random rays with the same origin, or with different ones.
void check_random_rays(Random& random, const Scene& scene, bool have_common_origin, Seen& seen) {
  const Primitives primitives(scene);
  PrimitiveSet open_triangles(primitives.count(), "triangles");
  for (PrimitiveId id = 0; id < primitives.count(); ++id) {
    const bool on_mesh = std::holds_alternative<Mesh>(primitives.object(id).shape);
    if (on_mesh && !random.one_in(4)) open_triangles.insert(id, id + 1);
  }
  std::vector<Ray> rays;
  const Vec3 common = origin(random, scene);
  for (int i = 0; i < 100; ++i) {
    const Vec3 o = have_common_origin ? common : origin(random, scene);
    rays.push_back(random_ray(random, scene, o));
  }
  check_rays(scene, open_triangles.pages(), rays, seen);
}

void expect_enough(const Seen& seen) {
  EXPECT_GT(seen.passed, 300U);
  EXPECT_GT(seen.missed, 300U);
  EXPECT_GT(seen.fronts, 300U);
}

TEST_P(OpenBacks, CameraRaysPassThrough) {
  Random random(41);
  Seen seen;
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE("scene " + std::to_string(round));
    check_random_rays(random, random_scene(random), round % 2 == 0, seen);
    if (HasFatalFailure()) return;
  }
  expect_enough(seen);
}

TEST_P(OpenBacks, CameraRaysPassThroughInstances) {
  Random random(42);
  Seen seen;
  for (int round = 0; round < 12; ++round) {
    for (const PlacementKind kind : kPlacementKinds) {
      SCOPED_TRACE("scene " + std::to_string(round));
      check_random_rays(random, random_placed_scenes(random, kind).instanced, round % 2 == 0, seen);
      if (HasFatalFailure()) return;
    }
  }
  expect_enough(seen);
}

/// Returns a triangle with vertices that differ in all coordinates, and a point that differs from
/// its plane only by the rounding of its coordinates.
Mesh triangle_at(Random& random, Vec3& point) {
  Mesh mesh;
  for (int i = 0; i < 3; ++i) mesh.positions.push_back(random.in_cube(1));
  mesh.triangles.push_back({0, 1, 2});
  const float a = 0.25F + 0.2F * random.symmetric(), b = 0.25F + 0.2F * random.symmetric();
  point = (1 - a - b) * mesh.positions[0] + a * mesh.positions[1] + b * mesh.positions[2];
  return mesh;
}

TEST_P(OpenBacks, SidesAreExactNearTheOrigin) {
  Random random(43);
  Seen seen;
  PrimitiveSet only_triangle(1, "triangles");
  only_triangle.insert(0, 1);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE("scene " + std::to_string(round));
    Vec3 point;
    Scene scene;
    scene.objects.push_back({.shape = triangle_at(random, point)});
    std::vector<Ray> rays;
    for (int i = 0; i < 64; ++i) rays.push_back(ray({point, random.in_cube(1)}));
    check_rays(scene, only_triangle.pages(), rays, seen);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(seen.missed, 1000U);
  EXPECT_GT(seen.fronts, 1000U);
}

}  // namespace
}  // namespace microtrace
