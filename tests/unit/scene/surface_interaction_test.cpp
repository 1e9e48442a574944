#include <microtrace/bvh.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/surface_interaction.hpp>

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

void expect_near(const DVec3& a, const DVec3& b, double tolerance = 1e-14) {
  for (glm::length_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "axis " << i;
}

SurfaceInteraction meet(const Scene& scene, const Ray& ray) {
  const Bvh bvh(scene, {.threads = 1});
  const std::optional<Hit> hit = bvh.intersect(ray);
  EXPECT_TRUE(hit.has_value());
  return hit ? interact(bvh.primitives(), ray, *hit) : SurfaceInteraction{};
}

SurfaceInteraction meet(Shape shape, const Ray& ray) {
  Scene scene;
  scene.objects.push_back({.name = "one", .shape = std::move(shape)});
  SurfaceInteraction result = meet(scene, ray);
  if (result.triangle) result.triangle->mesh = {};  // the scene is destroyed on return
  return result;
}

/// Returns the triangle (0,0,0) (1,0,0) (0,1,0), which faces +z.
Mesh corner() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

constexpr Ray kDown{.o = {0.25F, 0.5F, 3}, .d = {0, 0, -1}};
constexpr Ray kUp{.o = {0.25F, 0.5F, -3}, .d = {0, 0, 1}};

TEST(SurfaceInteraction, TriangleHasFrontAndBack) {
  const SurfaceInteraction front = meet(corner(), kDown);
  EXPECT_TRUE(front.front);
  expect_near(front.n, {0, 0, 1});
  expect_near(front.p, {0.25, 0.5, 0});
  ASSERT_TRUE(front.triangle);
  expect_near(front.triangle->barycentrics, {0.25, 0.25, 0.5});
  const SurfaceInteraction back = meet(corner(), kUp);
  EXPECT_FALSE(back.front);
  expect_near(back.n, {0, 0, 1});
}

TEST(SurfaceInteraction, VerticesAreInterpolated) {
  Scene scene;
  Mesh mesh = corner();
  mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.uv_sets = {{}, {{0, 0}, {2, 0}, {0, 4}}};
  mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0}};
  scene.objects.push_back({.name = "before", .shape = Sphere{{9, 9, 9}, 1}});
  scene.objects.push_back({.name = "mesh", .shape = mesh});
  const SurfaceInteraction met = meet(scene, kDown);
  expect_near(met.ns, glm::normalize(DVec3(0.25, 0.25, 0.5)));
  EXPECT_FALSE(met.uv(0));
  EXPECT_FALSE(met.uv(2));
  ASSERT_TRUE(met.uv(1));
  EXPECT_NEAR(met.uv(1)->x, 0.5, 1e-15);
  EXPECT_NEAR(met.uv(1)->y, 2, 1e-15);
  expect_near(DVec3(met.color()), {0.25, 0.25, 0.5});
  EXPECT_NEAR(met.color().w, 0.5, 1e-15);
}

TEST(SurfaceInteraction, MissingAttributesHaveDefaults) {
  Scene scene;
  scene.objects.push_back({.name = "mesh", .shape = corner()});
  const SurfaceInteraction met = meet(scene, kDown);
  EXPECT_EQ(met.ns, met.n);
  EXPECT_EQ(met.color(), DVec4(1));
  EXPECT_FALSE(met.uv(0));
}

TEST(SurfaceInteraction, NormalsThatCancelFallBackToTheGeometricNormal) {
  Mesh mesh = corner();
  mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 0}};
  expect_near(meet(mesh, kDown).ns, {0, 0, 1});
}

TEST(SurfaceInteraction, TriangleSeenEdgeOnLiesOnItsEdge) {
  const SurfaceInteraction met =
      meet(Triangle{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {.o = {0.5F, 0, 4}, .d = {0, 0, -1}});
  expect_near(met.p, {0.5, 0, 0});
  expect_near(met.n, {0, 0, 1});
  EXPECT_TRUE(met.front);
}

TEST(SurfaceInteraction, SphereFacesOutward) {
  const Sphere sphere{{1, 2, 3}, 2};
  const SurfaceInteraction outside = meet(sphere, {.o = {1.5F, 2.25F, 9}, .d = {0, 0, -1}});
  const DVec3 offset(0.5, 0.25, std::sqrt(4 - 0.25 - 0.0625));
  expect_near(outside.p, DVec3(1, 2, 3) + offset);
  expect_near(outside.n, offset / 2.0);
  EXPECT_TRUE(outside.front);
  const SurfaceInteraction inside = meet(sphere, {.o = {1, 2, 3}, .d = {0, 3, 0}});
  expect_near(inside.n, {0, 1, 0});
  EXPECT_FALSE(inside.front);
}

TEST(SurfaceInteraction, PlaneAndDiscFaceAlongTheirNormals) {
  const Ray ray{.o = {0.1F, 7, 0.3F}, .d = {0.1F, -1, 0.2F}};
  const DVec3 o(ray.o), d(ray.d);
  const double t = 7 / -d.y;
  const SurfaceInteraction plane = meet(Plane{{0, 0, 0}, {0, 3, 0}}, ray);
  expect_near(plane.p, o + t * d);
  expect_near(plane.n, {0, 1, 0});
  EXPECT_TRUE(plane.front);
  const SurfaceInteraction disc = meet(Disc{{0, 0, 0}, {0, -1, 0}, 9}, ray);
  expect_near(disc.p, o + t * d);
  EXPECT_FALSE(disc.front);
}

TEST(SurfaceInteraction, QuadricFacesWhereItsPolynomialGrows) {
  // The quadric x^2 + 2 y^2 + xy + z - 5 = 0, seen from above.
  const Quadric quadric{.a = 1, .b = 2, .d = 1, .i = 1, .j = -5};
  const SurfaceInteraction met = meet(quadric, {.o = {0.3F, 0.7F, 20}, .d = {0, 0, -2}});
  const double x = 0.3F, y = 0.7F;
  expect_near(met.p, {x, y, 5 - x * x - 2 * y * y - x * y}, 1e-13);
  expect_near(met.n, glm::normalize(DVec3(2 * x + y, 4 * y + x, 1)));
  EXPECT_TRUE(met.front);
}

TEST(SurfaceInteraction, QuadricOfASphereAgreesWithTheSphere) {
  // The sphere |p - (1, 2, 3)|^2 = 4.
  const Quadric quadric{.a = 1, .b = 1, .c = 1, .g = -2, .h = -4, .i = -6, .j = 10};
  const Ray ray{.o = {4.3F, 6.1F, 9.7F}, .d = {-0.31F, -0.42F, -0.63F}};
  const SurfaceInteraction a = meet(quadric, ray), b = meet(Sphere{{1, 2, 3}, 2}, ray);
  expect_near(a.p, b.p, 1e-13);
  expect_near(a.n, b.n, 1e-13);
}

TEST(SurfaceInteraction, ApexFacesTheRay) {
  const Quadric cone{.a = 1, .b = -1, .c = 1};
  const SurfaceInteraction met = meet(cone, {.o = {0, 0, 5}, .d = {0, 0, -1}});
  expect_near(met.n, {0, 0, 1});
}

TEST(SurfaceInteraction, RaysInThePlaneOfATriangleMeetItWhereTheyEnter) {
  const Ray along{.o = {-1, 0.25F, 0}, .d = {1, 0, 0}};
  const SurfaceInteraction entering = meet(corner(), along);
  EXPECT_EQ(entering.p, DVec3(0, 0.25, 0));
  EXPECT_EQ(entering.triangle->barycentrics, DVec3(0.75, 0, 0.25));
  EXPECT_TRUE(entering.front);
  const SurfaceInteraction inside = meet(corner(), {.o = {0.25F, 0.25F, 0}, .d = {1, 0, 0}});
  EXPECT_EQ(inside.p, DVec3(0.25, 0.25, 0));
  expect_near(inside.triangle->barycentrics, {0.5, 0.25, 0.25});
}

// The values of these rays are exact in float32, so the rays lie in the triangles' planes although
// no coordinate is 0.
TEST(SurfaceInteraction, PointsOfRaysInObliquePlanesAreOnTheRays) {
  std::minstd_rand random(1);
  const auto number = [&] { return static_cast<float>(static_cast<int>(random() % 33) - 16); };
  int met = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vec3 a(number(), number(), number()), b(number(), number(), number()),
        c(number(), number(), number());
    const Vec3 d = (b - a) * number() + (c - a) * number();
    const Vec3 o = a + (b - a) * number() + (c - a) * number() - d * 4.0F;
    if (d == Vec3(0)) continue;
    Scene scene;
    scene.objects.push_back({.name = "one", .shape = Triangle{a, b, c}});
    const Bvh bvh(scene);
    const Ray ray{.o = o, .d = d};
    const auto hit = bvh.intersect(ray);
    if (!hit) continue;
    ++met;
    const DVec3 on_ray = DVec3(o) + double{hit->t} * DVec3(d);
    const double size = glm::length(DVec3(o)) + glm::length(double{hit->t} * DVec3(d));
    EXPECT_LT(glm::length(interact(bvh.primitives(), ray, *hit).p - on_ray), 0x1p-22 * size);
  }
  EXPECT_GT(met, 400);
}

// A double plane has two fronts, because its polynomial is positive on both sides.
TEST(SurfaceInteraction, DoublePlanesShowTheirFronts) {
  for (int i = 0; i < 100; ++i) {
    const auto x = static_cast<float>(i);
    const Ray ray{.o = {-3.3F, 0.1F, 5.7F}, .d = {0.57F + 0.001F * x, 0.013F * x, -1}};
    const SurfaceInteraction plane = meet(Quadric{.c = 1}, ray);
    EXPECT_TRUE(plane.front);
    EXPECT_EQ(plane.p.z, 0);
    expect_near(plane.n, -glm::normalize(DVec3(ray.d)));
    EXPECT_FALSE(meet(Quadric{.c = -1}, ray).front);
  }
}

TEST(SurfaceInteraction, TangentsTouchTheFrontsOfSpheres) {
  const SurfaceInteraction touched = meet(Sphere{{0, 0, 0}, 3}, {.o = {-5, 3, 0}, .d = {1, 0, 0}});
  EXPECT_TRUE(touched.front);
  EXPECT_EQ(touched.p, DVec3(0, 3, 0));
  EXPECT_EQ(touched.n, DVec3(0, 1, 0));
}

// The expected point was computed with 300 bits.
TEST(SurfaceInteraction, SmallDistantSpheresHaveExactPoints) {
  const Sphere sphere{{6.551185131072998F, -4.735469341278076F, -8.705358505249023F},
                      0.0028079068F};
  const Ray ray{.o = {-7.797708034515381F, -3.4627416133880615F, 8.025738716125488F},
                .d = {0.6499149799346924F, -0.057558126747608185F, -0.7578242421150208F}};
  expect_near(meet(sphere, ray).p, {6.549842523461461, -4.733397251478956, -8.704021273247774},
              5e-15);
}

// Both roots have the same float32 neighbor as t.
TEST(SurfaceInteraction, RaysArriveAtTheNearSidesOfDistantSpheres) {
  const SurfaceInteraction near =
      meet(Sphere{{0, 0, 1}, 1}, {.o = {0, 0, 50000008}, .d = {0, 0, -1}});
  EXPECT_TRUE(near.front);
  EXPECT_EQ(near.p, DVec3(0, 0, 2));
  EXPECT_EQ(near.n, DVec3(0, 0, 1));
  const SurfaceInteraction from_center =
      meet(Sphere{{0, 0, 1}, 1}, {.o = {0, 0, 50000008}, .t_min = 50000008, .d = {0, 0, -1}});
  EXPECT_FALSE(from_center.front);
  EXPECT_EQ(from_center.p, DVec3(0, 0, 0));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  const auto any = [&] { return Vec3(coordinate(random), coordinate(random), coordinate(random)); };
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    const Sphere sphere{any(), 1e-6F};
    Ray ray{.o = 100.0F * any()};
    ray.d = Vec3(DVec3(sphere.center) + 0.3e-6 * DVec3(any()) - DVec3(ray.o));
    Scene scene;
    scene.objects.push_back({.shape = sphere});
    const Bvh bvh(scene, {.threads = 1});
    const std::optional<Hit> hit = bvh.intersect(ray);
    if (!hit) continue;
    ++hits;
    const SurfaceInteraction surface = interact(bvh.primitives(), ray, *hit);
    EXPECT_TRUE(surface.front);
    EXPECT_LE(glm::dot(surface.n, DVec3(ray.d)), 0);
  }
  EXPECT_GT(hits, 100);
}

// The normals were computed with rational numbers.
TEST(SurfaceInteraction, NormalsOfSliversAndTinySpheresAreExact) {
  const Triangle sliver{{-0.8467972874641418F, 0.9978864192962646F, 0.3872188329696655F},
                        {6.262633386731236e-17F, 1, -5.072985141433227e-16F},
                        {1.6646579693711154e-16F, 1, -5.015270433989688e-16F}};
  const SurfaceInteraction at_sliver =
      meet(sliver, {.o = {6.262633386731236e-17F, 2, -5.072985141433227e-16F}, .d = {0, -1, 0}});
  expect_near(at_sliver.n, {0.00027, -0.99999, -0.00487}, 1e-5);
  EXPECT_FALSE(at_sliver.front);
  const Sphere tiny{{-0x1.6531f6p-2F, 0x1.cf5cp-5F, -0x1.61e928p-4F}, 0x1.df71ccp-40F};
  const SurfaceInteraction at_sphere =
      meet(tiny,
           {.o = {-0.3488233983516693F, 0.05656242370605469F, 668532224}, .d = {0, 0, -668532224}});
  EXPECT_TRUE(at_sphere.front);
  EXPECT_GT(at_sphere.n.z, 0);
}

TEST(SurfaceInteraction, SidesOfPlanesAndDiscsAreExact) {
  // The product of the directions is -2^-60. That of the rounded unit normal is positive.
  const Ray ray{.o = {0, 0, 0x1p-60F}, .d = {-5, 2, -0x1p-60F}};
  EXPECT_TRUE(meet(Plane{{0, 0, 0}, {2, 5, 1}}, ray).front);
  EXPECT_TRUE(meet(Disc{{0, 0, 0}, {2, 5, 1}, 9}, ray).front);
  EXPECT_FALSE(meet(Plane{{0, 0, 0}, {-2, -5, -1}}, ray).front);
}

TEST(SurfaceInteraction, WeightsOfExtremelyDistantTrianglesAreExact) {
  const Triangle triangle{{0x1p-20F, 0, 0}, {0, 0x1p-20F, 0}, {0, 0, 0x1p-21F}};
  for (const float distance : {1.0F, 1e4F, 1e8F, 1e12F}) {
    const Ray ray{.o = Vec3(distance), .d = Vec3(-1)};
    // The ray meets the plane x + y + 2 z = 2^-20 where x = y = z = 2^-22.
    const SurfaceInteraction surface = meet(triangle, ray);
    ASSERT_TRUE(surface.triangle);
    expect_near(surface.triangle->barycentrics, {0.25, 0.25, 0.5}, 1e-3);
  }
}

TEST(SurfaceInteraction, SidesOfTrianglesAreExact) {
  // n . d is positive, but float64 gives a negative number.
  const Triangle triangle{{2, 0, -1}, {0x1p-61F, 0x1p-60F, 0x1p-60F}, {0, 0x1p-41F, 0}};
  EXPECT_FALSE(shows_front(triangle, {0x1.8p-62F, -0x1.ffffcp-43F, 0x1.8p-63F}));
  EXPECT_TRUE(shows_front(triangle, {-0x1.8p-62F, 0x1.ffffcp-43F, -0x1.8p-63F}));
}

// Position and t are finite in float64 where t exceeds float32.
TEST(SurfaceInteraction, DistantPointsOfQuadricsAreFinite) {
  const Ray ray{.o = {3, 4, -4}, .d = {0x1p-149F, 0, 0}};
  EXPECT_EQ(meet(Quadric{.a = 1, .b = -1}, ray).p, DVec3(4, 4, -4));
}

TEST(SurfaceInteraction, ParametersBeyondFloat32FindTheRightPoint) {
  // The other root is negative.
  const SurfaceInteraction within =
      meet(Sphere{{0, 0, 0}, 1}, {.o = {0, 0, 0}, .d = {1e-39F, 0, 0}});
  EXPECT_EQ(within.p, DVec3(1, 0, 0));
  EXPECT_EQ(within.n, DVec3(1, 0, 0));
  EXPECT_FALSE(within.front);
  // In float64, n . d is 0. Exactly, it is -3 * 2^-149.
  const SurfaceInteraction oblique =
      meet(Plane{{0, -1, 1}, {-1, 1, -1}},
           {.o = {-0.49999997F, 1, 0.9999999F}, .d = {0x1.8p-148F, 1, 1}});
  EXPECT_NEAR(oblique.p.y / 5.95e44, 1, 0.01);
  EXPECT_TRUE(oblique.front);
}

}  // namespace
}  // namespace microtrace
