#include <microtrace/error.hpp>
#include <microtrace/queries.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

using testing::ElementsAre;

// Returns a cube whose faces don't share vertices, as in glTF.
Mesh cube(const Vec3& lo, float edge) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (int i = 0; i < 4; ++i) {
        Vec3 corner{0};
        corner[axis] = static_cast<float>(side);
        corner[(axis + 1) % 3] = static_cast<float>(i & 1);
        corner[(axis + 2) % 3] = static_cast<float>(i >> 1 & 1);
        mesh.positions.push_back(lo + edge * corner);
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first + 1, first + 3, first + 2});
    }
  }
  return mesh;
}

Scene queried_scene(std::vector<Shape> shapes) {
  Scene scene;
  for (Shape& shape : shapes) scene.objects.push_back({.name = "", .shape = std::move(shape)});
  return scene;
}

Location locate(const Solid& solid, const Vec3& p) {
  Location location = Location::outside;
  solid.locate(std::span(&p, 1), std::span(&location, 1));
  return location;
}

std::optional<NearestPoint> nearest(const Solid& solid, const Vec3& p) {
  std::optional<NearestPoint> result;
  solid.nearest_points(std::span(&p, 1), std::span(&result, 1));
  return result;
}

double signed_distance(const Solid& solid, const Vec3& p) {
  double distance = 0;
  solid.signed_distances(std::span(&p, 1), std::span(&distance, 1));
  return distance;
}

TEST(Queries, ReturnRaggedHits) {
  const PreparedScene scene(queried_scene({Sphere{}, cube(Vec3(-2), 4), cube(Vec3(-2), 4)}));
  const std::vector<Ray> rays{{.o = {0.25F, 0.5F, 5}}, {.o = {9, 9, 9}}, {.o = {0.25F, 0.5F, 0}}};
  const RayHits all = intersect_all(scene, rays);
  EXPECT_THAT(all.offsets, ElementsAre(0, 5, 5, 8));
  std::vector<PrimitiveId> ids;
  for (const Hit& hit : all.of(0)) ids.push_back(hit.id);
  // The ray crosses both cubes, the sphere, and both cubes again. Hits at equal t are ordered by
  // primitive number.
  EXPECT_THAT(ids, ElementsAre(12, 24, 0, 10, 22));
  std::vector<std::uint32_t> counts(3);
  count_crossings(scene, rays, counts);
  EXPECT_THAT(counts, ElementsAre(5, 0, 3));
}

TEST(Queries, CountEachTriangleAtAnEdge) {
  const PreparedScene scene(queried_scene({cube(Vec3(0), 1)}));
  const std::vector<Ray> rays{
      {.o = {0.5F, 0.5F, 2}},     // through the diagonals of two faces
      {.o = {1, 0.25F, 2}},       // through two edges, and both triangles of the face between them
      {.o = {1, 1, 2}},           // along an edge: both triangles of two faces, one of two others
      {.o = {0.25F, 0.25F, 1}}};  // starts on a face, which does not count
  std::vector<std::uint32_t> counts(rays.size());
  count_crossings(scene, rays, counts);
  EXPECT_THAT(counts, ElementsAre(4, 4, 6, 1));
}

TEST(Solid, IsClosedIfVerticesAreEqual) {
  EXPECT_TRUE(Solid{PreparedScene(queried_scene({cube(Vec3(1, 2, 3), 0.1F)}))}.is_closed());
  EXPECT_TRUE(Solid{PreparedScene(Scene{})}.is_closed());
  // Two cubes that touch in a common face. Their vertices have both 0 and -0.
  EXPECT_TRUE((Solid{PreparedScene(queried_scene({cube(Vec3(0), 1), cube({-1, -0.0F, -0.0F}, 1)}))}
                   .is_closed()));
}

TEST(Solid, TellsOpenEdges) {
  Mesh mesh = cube(Vec3(0), 2);
  mesh.triangles.edit().pop_back();
  Scene scene = queried_scene({Sphere{}, mesh});
  scene.origin = {100, 0, 0};
  const Solid solid{PreparedScene(std::move(scene))};
  EXPECT_FALSE(solid.is_closed());
  const auto edges = solid.open_edges();
  ASSERT_EQ(edges.size(), 3U);
  for (const OpenEdge& edge : edges) {
    EXPECT_EQ(edge.count, 1U);
    EXPECT_LE(edge.side, 2U);
    // The triangle that was removed lies in the plane z = 2.
    EXPECT_EQ(edge.a.z, 2);
    EXPECT_EQ(edge.b.z, 2);
    EXPECT_GE(edge.a.x, 100);
  }
  EXPECT_LT(edges[0].triangle, edges[1].triangle);
  EXPECT_LT(edges[1].triangle, edges[2].triangle);
}

TEST(Solid, IgnoresTrianglesThatAreNotFinite) {
  Mesh mesh = cube(Vec3(0), 2);
  mesh.positions.edit()[0].x = std::numeric_limits<float>::infinity();
  const Solid solid{PreparedScene(queried_scene({mesh}))};
  EXPECT_EQ(solid.open_edges().size(), 3U);
  EXPECT_TRUE(nearest(solid, Vec3(1)).has_value());
}

TEST(Solid, LocatesByParity) {
  // Nested cubes: a solid with a cavity that contains another cube.
  const Solid solid{PreparedScene(
      queried_scene({cube(Vec3(0), 9), cube(Vec3(1), 7), cube(Vec3(2), 5), Sphere{Vec3(20), 3}}))};
  EXPECT_EQ(locate(solid, Vec3(-1)), Location::outside);
  EXPECT_EQ(locate(solid, Vec3(0)), Location::boundary);
  EXPECT_EQ(locate(solid, Vec3(0.5F)), Location::inside);
  EXPECT_EQ(locate(solid, {4, 4, 1}), Location::boundary);
  EXPECT_EQ(locate(solid, Vec3(1.5F)), Location::outside);
  EXPECT_EQ(locate(solid, Vec3(4)), Location::inside);
  EXPECT_EQ(locate(solid, Vec3(20)), Location::outside);  // spheres don't count
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(locate(solid, {nan, 4, 4}), Location::outside);
  EXPECT_EQ(signed_distance(solid, Vec3(4)), -2);
  EXPECT_EQ(signed_distance(solid, Vec3(2)), 0);
  EXPECT_EQ(signed_distance(solid, {4, 4, -3}), 3);
}

TEST(Solid, CanBeOneObject) {
  const PreparedScene scene(
      queried_scene({cube(Vec3(0), 4), Plane{}, cube(Vec3(0), 4), cube(Vec3(2), 4)}));
  const Solid all(scene), second(scene, 2), third(scene, 3), plane(scene, 1);
  // The two equal cubes cancel each other.
  EXPECT_EQ(locate(all, Vec3(1)), Location::outside);
  EXPECT_EQ(locate(second, Vec3(1)), Location::inside);
  EXPECT_EQ(locate(third, Vec3(1)), Location::outside);
  EXPECT_EQ(locate(third, Vec3(4)), Location::inside);
  EXPECT_EQ(locate(second, {4, 1, 1}), Location::boundary);
  EXPECT_EQ(locate(third, {4, 1, 1}), Location::outside);
  EXPECT_LT(nearest(all, Vec3(-1))->id, 12U);
  EXPECT_GE(nearest(second, Vec3(-1))->id, 13U);
  EXPECT_LT(nearest(second, Vec3(-1))->id, 25U);
  EXPECT_GE(nearest(third, Vec3(-1))->id, 25U);
  EXPECT_EQ(nearest(plane, Vec3(-1)), std::nullopt);
  EXPECT_EQ(signed_distance(plane, Vec3(-1)), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(plane.is_closed());
  EXPECT_THROW((Solid{scene, 4}), Error);
}

TEST(Solid, FindsNearestPoints) {
  Scene scene = queried_scene({Sphere{}, Triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}});
  scene.origin = {1, 2, 3};
  const Solid solid{PreparedScene(std::move(scene))};
  const auto found = nearest(solid, {2, 3, 8});
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->id, 1U);
  EXPECT_EQ(found->distance, 5);
  EXPECT_EQ(found->p, DVec3(2, 3, 3));
  EXPECT_EQ(found->barycentrics, DVec3(0.5, 0.25, 0.25));
}

TEST(Solid, KeepsThePrecisionOfPointsFarFromTheOrigin) {
  Scene scene = queried_scene({cube(Vec3(0), 1)});
  const DVec3 far(0x1p25 + 0.125, -0x1p24, 0.5);
  scene.origin = far;
  const Solid solid{PreparedScene(std::move(scene))};
  const std::vector<DVec3> points{far + DVec3(0.25, 0.5, 0.5), far + DVec3(0, 0.5, 0.5),
                                  far - DVec3(0.25, -0.5, -0.5)};
  std::vector<Location> locations(3);
  solid.locate(points, locations);
  EXPECT_THAT(locations, ElementsAre(Location::inside, Location::boundary, Location::outside));
  std::vector<std::optional<NearestPoint>> nearest(3);
  solid.nearest_points(points, nearest);
  for (const auto& each : nearest) EXPECT_EQ(each.value().p, far + DVec3(0, 0.5, 0.5));
  std::vector<double> distances(3);
  solid.signed_distances(points, distances);
  EXPECT_THAT(distances, ElementsAre(-0.25, 0, 0.25));
}

TEST(Solid, FindsTheLowestOfEquallyNearTriangles) {
  // The query points are near a corner of five triangles, an edge, and a face that occurs three
  // times.
  const Solid solid{
      PreparedScene(queried_scene({cube(Vec3(0), 1), cube(Vec3(0), 1), cube(Vec3(0), 1)}))};
  EXPECT_EQ(nearest(solid, {-1, -1, -1})->id, 0U);
  EXPECT_EQ(nearest(solid, {2, 2, 2})->id, 3U);
  EXPECT_EQ(nearest(solid, {0.25F, 0.25F, 2})->id, 10U);
  EXPECT_EQ(nearest(solid, Vec3(0.5F))->id, 0U);
}

// ---- Threads and cancellation

struct ManyPoints {
  Solid solid{PreparedScene(queried_scene({cube(Vec3(0), 1), cube(Vec3(0.25F), 1)}))};
  std::vector<Vec3> points;
  std::vector<Location> locations;

  ManyPoints() : locations(200'000) {
    for (std::size_t i = 0; i < locations.size(); ++i)
      points.push_back(Vec3(0.001F * static_cast<float>(i % 2000)));
  }
};

TEST(Queries, ResultsDoNotDependOnThreads) {
  ManyPoints many;
  many.solid.locate(many.points, many.locations, {.threads = 1});
  const std::vector<Location> expected = many.locations;
  many.locations.assign(many.points.size(), Location::outside);
  many.solid.locate(many.points, many.locations, {.threads = 3});
  EXPECT_EQ(many.locations, expected);
  many.locations.assign(many.points.size(), Location::outside);
  unsigned wanted = 0;
  many.solid.locate(many.points, many.locations,
                    {.threads = 2, .run_threads = [&](unsigned threads, const auto& work) {
                       wanted = threads;
                       const std::jthread other(work);
                       work();
                     }});
  EXPECT_EQ(wanted, 2U);
  EXPECT_EQ(many.locations, expected);
}

TEST(Queries, RefuseThreadsThatDoNotWork) {
  ManyPoints many;
  const QueryOptions idle{.run_threads = [](unsigned, const std::function<void()>&) {}};
  EXPECT_THROW(many.solid.locate(many.points, many.locations, idle), Error);
}

TEST(Queries, ReportProgress) {
  ManyPoints many;
  double last = 0;
  many.solid.locate(many.points, many.locations, {.progress = [&](double done) {
                      EXPECT_LE(last, done);
                      last = done;
                      return true;
                    }});
  EXPECT_EQ(last, 1);
  last = 0;
  count_crossings(PreparedScene(Scene{}), {}, {}, {.progress = [&](double done) {
                    last = done;
                    return true;
                  }});
  EXPECT_EQ(last, 1);
}

ErrorKind kind_of_failure(const auto& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::internal;
}

TEST(Queries, CanBeCanceled) {
  ManyPoints many;
  int calls = 0;
  const QueryOptions options{.threads = 2, .progress = [&](double) {
                               ++calls;
                               return false;
                             }};
  EXPECT_EQ(kind_of_failure([&] { many.solid.locate(many.points, many.locations, options); }),
            ErrorKind::canceled);
  EXPECT_EQ(calls, 1);
}

// The ray hits a hundred thousand triangles that can be ordered only by exact arithmetic.
TEST(Queries, CanBeCanceledWithinOneRay) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    const float z = 1 + 0x1p-23F * static_cast<float>(i % 8);
    const auto k = static_cast<float>(i);
    for (const Vec3& p : {Vec3(-1 - k, -1, z), Vec3(3, -1, z), Vec3(-1, 3 + k, z + 0x1p-22F)})
      mesh.positions.push_back(p);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const PreparedScene scene(queried_scene({std::move(mesh)}));
  const Ray ray{.o = Vec3(0), .d = {0.01F, 0.02F, 1}};
  int calls = 0;
  const auto f = [&] {
    (void)intersect_all(scene, std::span(&ray, 1), {.progress = [&](double done) {
                          EXPECT_EQ(done, 0);
                          ++calls;
                          return false;
                        }});
  };
  EXPECT_EQ(kind_of_failure(f), ErrorKind::canceled);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace microtrace
