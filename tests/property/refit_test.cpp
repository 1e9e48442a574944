// Checks that a refitted tree keeps the invariants of a tree and gives the same hits as a new tree.

#include "accel/build/refit.hpp"

#include "accel/build/tree.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/cases/generated_meshes.hpp"
#include "support/tree_walk.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/error.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/validate.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

Scene scene_of(std::vector<Shape> shapes) {
  Scene scene;
  for (Shape& shape : shapes) scene.objects.push_back({.name = "", .shape = std::move(shape)});
  return scene;
}

/// Returns a mesh with duplicates and points, a triangle that is too large for blocks, and other
/// shapes.
Scene mixed() {
  Mesh mesh = generated::hall(4000);
  for (std::size_t i = 0; i < 50; ++i) {
    const auto [a, b, c] = mesh.triangles[7 * i];
    mesh.triangles.push_back({b, a, c});
    mesh.triangles.push_back({a, a, a});
  }
  Scene scene = scene_of({mesh, generated::displaced_sphere(2000), Plane{.point = {0, -3, 0}},
                          Triangle{{-0x1p40F, 0, 1}, {0x1p40F, 0, 1}, {0, 0x1p40F, 2}},
                          Quadric{.a = 1, .b = 2, .c = 1, .j = -40}});
  for (int i = 0; i < 40; ++i) {
    const auto x = static_cast<float>(i);
    scene.objects.push_back({.name = "", .shape = Sphere{{x, 3, 0}, 0.3F}});
    scene.objects.push_back({.name = "", .shape = Disc{{x, 1, 0}, {x, 1, 0}, 0.5F}});
  }
  return scene;
}

template <class F>
void for_each_point(Scene& scene, const F& move) {
  for (Object& object : scene.objects) {
    std::visit(
        [&]<class AnyShape>(AnyShape& s) {
          if constexpr (std::is_same_v<AnyShape, Mesh>) {
            for (Vec3& p : s.positions.edit()) move(p);
          } else if constexpr (std::is_same_v<AnyShape, Triangle>) {
            for (Vec3* p : {&s.a, &s.b, &s.c}) move(*p);
          } else if constexpr (std::is_same_v<AnyShape, Plane>) {
            move(s.point);
          } else if constexpr (std::is_same_v<AnyShape, Quadric>) {
            Vec3 linear(s.g, s.h, s.i);
            move(linear);
            s.g = linear.x, s.h = linear.y, s.i = linear.z;
          } else {
            move(s.center);
          }
        },
        object.shape);
  }
}

struct Deformation {
  const char* name;
  std::function<void(Scene&, Random&)> apply;
  std::size_t rays = 300;
};

/// The number of rays for deformations whose rays are slow. Rays beyond the kernels' limits, and
/// coordinates of all magnitudes, need exact arithmetic.
constexpr std::size_t kFewRays = 10;

Deformation of_points(const char* name, std::function<void(Vec3&, Random&)> move,
                      std::size_t rays = 300) {
  return {name,
          [move = std::move(move)](Scene& scene, Random& random) {
            for_each_point(scene, [&](Vec3& p) { move(p, random); });
          },
          rays};
}

const std::vector<Deformation>& deformations() {
  static const std::vector<Deformation> all{
      of_points("nothing", [](Vec3&, Random&) {}),
      of_points("an ulp", [](Vec3& p, Random& random) { p = random.jitter(p, 1); }),
      of_points("a little", [](Vec3& p, Random& random) { p += random.in_cube(0.01F); }),
      of_points("a wave", [](Vec3& p, Random&) { p.y += 0.3F * p.x * p.x - 0.2F * p.z; }),
      of_points("everywhere", [](Vec3& p, Random& random) { p = random.in_cube(20); }),
      of_points("huge", [](Vec3& p, Random&) { p *= 0x1p30F; }),
      of_points(
          "too large for blocks", [](Vec3& p, Random&) { p *= 0x1p36F; }, kFewRays),
      of_points(
          "far beyond", [](Vec3& p, Random&) { p *= 0x1p120F; }, kFewRays),
      of_points(
          "tiny", [](Vec3& p, Random&) { p *= 0x1p-140F; }, kFewRays),
      of_points("to a point",
                [](Vec3& p, Random&) {
                  p = {1, 2, 3};
                }),
      of_points("to a line",
                [](Vec3& p, Random&) {
                  p = {p.x, 0, 0};
                }),
      of_points(
          "to a plane", [](Vec3& p, Random&) { p.y = 0; }, kFewRays),
      of_points("to a grid", [](Vec3& p, Random& random) { p = random.on_grid(4); }),
      of_points("mirrored", [](Vec3& p, Random&) { p.x = -p.x; }),
      of_points("some not finite",
                [](Vec3& p, Random& random) {
                  if (random.one_in(100)) p.y = std::numeric_limits<float>::quiet_NaN();
                }),
      {"one object only",
       [](Scene& scene, Random&) {
         if (auto* mesh = std::get_if<Mesh>(&scene.objects.front().shape))
           for (Vec3& p : mesh->positions.edit()) p.x += 0.5F;
       }},
      {"other triangles",
       [](Scene& scene, Random&) {
         if (auto* mesh = std::get_if<Mesh>(&scene.objects.front().shape))
           std::ranges::reverse(mesh->triangles.edit());
       }},
      {"one triangle less",
       [](Scene& scene, Random&) {
         if (auto* mesh = std::get_if<Mesh>(&scene.objects.front().shape))
           mesh->triangles.edit().pop_back();
       }},
      {"another shape",
       [](Scene& scene, Random&) {
         if (scene.objects.size() > 1) scene.objects.back().shape = Plane{.point = {0, 9, 0}};
       }},
  };
  return all;
}

/// Returns rays between points of the scene, including rays through vertices and along edges.
std::vector<Ray> rays_in(const Scene& scene, Random& random, std::size_t count) {
  const Primitives primitives(scene);
  std::vector<Vec3> points;
  primitives.for_each([&](PrimitiveId, const auto& shape) {
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Triangle>) {
      for (const Vec3& p : {shape.a, shape.b, shape.c}) points.push_back(p);
    }
  });
  const auto point = [&] {
    return points[static_cast<std::size_t>(random.between(0, static_cast<int>(points.size()) - 1))];
  };
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Vec3 a = point(), b = point(), c = 0.5F * a + 0.5F * point();
    const Vec3 from = rays.size() % 2 == 0 ? a + 3.0F * (a - b) : c;
    rays.push_back({.o = from, .d = b - from});
    if (rays.size() % 3 == 0)  // some rays have a common origin, as in a packet
      for (int i = 0; i < 9; ++i) rays.push_back({.o = from, .d = point() - from});
  }
  return rays;
}

void expect_same(const std::optional<Hit>& expected, const std::optional<Hit>& actual) {
  ASSERT_EQ(expected.has_value(), actual.has_value());
  if (!expected) return;
  ASSERT_EQ(expected->id, actual->id);
  ASSERT_EQ(expected->t, actual->t);
}

void expect_same_answers(const Bvh& expected, const Bvh& actual, const std::vector<Ray>& rays) {
  std::vector<std::optional<Hit>> hits(rays.size()), others(rays.size());
  expected.intersect(rays, hits);
  actual.intersect(rays, others);
  const auto are_occluded = [&](const Bvh& bvh) {
    const auto results = std::make_unique<bool[]>(rays.size());
    bvh.occluded(rays, {results.get(), rays.size()});
    return std::vector<bool>(results.get(), results.get() + rays.size());
  };
  EXPECT_EQ(are_occluded(expected), are_occluded(actual));
  std::vector<Bvh::Spawn> spawns;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_NO_FATAL_FAILURE(expect_same(hits[i], others[i]));
    ASSERT_NO_FATAL_FAILURE(expect_same(hits[i], actual.intersect(rays[i])));
    if (!hits[i]) continue;
    spawns.push_back({.ray = &rays[i], .hit = *hits[i], .direction = {-0.3F, 1, 0.2F}});
    for (int k = 0; k < 4 && hits[i]; ++k) {
      const std::optional<Hit> next = expected.next(rays[i], *hits[i]);
      ASSERT_NO_FATAL_FAILURE(expect_same(next, actual.next(rays[i], *hits[i])));
      hits[i] = next;
    }
  }
  std::vector<std::optional<Vec3>> origins(spawns.size()), other_origins(spawns.size());
  expected.spawn_origins(spawns, origins);
  actual.spawn_origins(spawns, other_origins);
  EXPECT_EQ(origins, other_origins);
}

void expect_whole(const Tree& tree, const Primitives& primitives, const Tree& fresh) {
  const TreeWalk walk(tree, primitives), wanted(fresh, primitives);
  EXPECT_EQ(walk.fault(), "");
  primitives.for_each([&](PrimitiveId id, const auto&) {
    if (walk.place(id) != wanted.place(id) && !testing::Test::HasFailure())
      ADD_FAILURE() << "primitive " << id << " is in another kind of leaf";
  });
}

constexpr double kAny = std::numeric_limits<double>::infinity();

std::shared_ptr<const Tree> tree_of(const Scene& scene, std::shared_ptr<const Tree> previous = {},
                                    double growth = kAny, unsigned threads = 1) {
  return std::make_shared<const Tree>(
      build_tree(Primitives(scene),
                 {.threads = threads, .previous = std::move(previous), .max_cost_growth = growth}));
}

bool is_refitted(const Tree& tree) {
  return tree.built_cost.has_value();
}

double cost(const Tree& tree) {
  return build::relative_cost(tree).to_tree;
}

class Refit : public testing::TestWithParam<std::string> {
 protected:
  static Scene scene() {
    if (GetParam() == "mixed") return mixed();
    if (GetParam() == "sphere") return scene_of({generated::displaced_sphere(3000)});
    return scene_of({generated::terrain(1000), generated::turned(generated::hall(6000))});
  }
};

TEST_P(Refit, GivesTheHitsOfANewTreeForEveryDeformation) {
  for (const Deformation& deformation : deformations()) {
    SCOPED_TRACE(deformation.name);
    Random random(1);
    const Scene first = scene();
    Scene second = first;
    deformation.apply(second, random);
    const std::shared_ptr<const Tree> previous = tree_of(first);
    const Primitives primitives(second);
    const std::shared_ptr<const Tree> fresh = tree_of(second);
    expect_whole(*tree_of(second, previous), primitives, *fresh);
    const Bvh before(first);
    const Bvh expected(second),
        actual(second, {.threads = 1, .previous = before.tree(), .max_cost_growth = kAny});
    expect_same_answers(expected, actual, rays_in(second, random, deformation.rays));
    // Moves the scene back to its first pose.
    const Bvh again(first, {.threads = 1, .previous = actual.tree(), .max_cost_growth = kAny});
    expect_same_answers(before, again, rays_in(first, random, 100));
    if (HasFailure()) return;
  }
}

TEST_P(Refit, GivesTheHitsOfANewTreeForManyFrames) {
  Random random(2);
  Scene now = scene();
  std::shared_ptr<const BvhTree> previous;
  std::shared_ptr<const Tree> tree;
  int refits = 0;
  for (int frame = 0; frame < 40; ++frame) {
    const double growth = frame % 8 == 0 ? 1.01 : kAny;
    tree = tree_of(now, tree, growth, frame % 2 == 0 ? 1 : 7);
    refits += is_refitted(*tree);
    expect_whole(*tree, Primitives(now), *tree_of(now));
    const Bvh actual(now, {.threads = 1, .previous = previous, .max_cost_growth = growth});
    expect_same_answers(Bvh(now), actual, rays_in(now, random, 60));
    previous = actual.tree();
    ASSERT_FALSE(HasFailure()) << frame;
    const float phase = static_cast<float>(frame);
    for_each_point(now, [&](Vec3& p) {
      p += 0.05F * Vec3(p.y, -p.x, 0.1F * static_cast<float>(std::abs(p.x + phase)));
    });
  }
  EXPECT_GE(refits, 20);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Refit, testing::Values("mixed", "sphere", "large"),
                         [](const auto& instance) { return instance.param; });

bool have_same_boxes(const WideNode& a, const WideNode& b) {
  return std::memcmp(&a, &b, offsetof(WideNode, child) + sizeof a.child) == 0;
}

TEST(RefitTree, IsTheSameForAnyNumberOfThreads) {
  const Scene first = scene_of({generated::displaced_sphere(80000), generated::hall(20000)});
  Scene second = first;
  for_each_point(second, [](Vec3& p) { p.y += 0.1F * p.x; });
  const auto one = tree_of(second, tree_of(first)),
             seven = tree_of(second, tree_of(first), kAny, 7);
  EXPECT_TRUE(is_refitted(*one));
  EXPECT_TRUE(std::ranges::equal(one->nodes, seven->nodes, have_same_boxes));
  EXPECT_EQ(one->built_cost->to_tree, seven->built_cost->to_tree);
}

TEST(RefitTree, OfAStillSceneIsTheTreeItself) {
  const Scene scene = scene_of({generated::turned(generated::hall(20000))});
  const auto built = tree_of(scene), fitted = tree_of(scene, built);
  EXPECT_TRUE(is_refitted(*fitted));
  EXPECT_TRUE(std::ranges::equal(built->nodes, fitted->nodes, have_same_boxes));
  EXPECT_EQ(cost(*built), cost(*fitted));
  EXPECT_EQ(built->bounds.lo, fitted->bounds.lo);
}

TEST(RefitTree, KeepsTheBoxesOfWhatDoesNotMove) {
  // The scene has a static hall whose split triangles have separate boxes, and a mesh that moves in
  // it.
  const Mesh hall = generated::turned(generated::hall(20000));
  Scene scene = scene_of({generated::displaced_sphere(20000), hall});
  const auto built = tree_of(scene);
  for (Vec3& p : std::get<Mesh>(scene.objects[0].shape).positions.edit()) p.x += 0.01F;
  const auto moved = tree_of(scene, built);
  ASSERT_TRUE(is_refitted(*moved));
  EXPECT_LT(cost(*moved), 1.02 * cost(*built));
}

TEST(RefitTree, ThatCostsTooMuchIsBuiltAnew) {
  Random random(3);
  const Scene first = scene_of({generated::displaced_sphere(20000)});
  Scene second = first;
  for_each_point(second, [](Vec3& p) { p *= 2.0F; });
  EXPECT_TRUE(is_refitted(*tree_of(second, tree_of(first), 1.001)));
  for_each_point(second, [&](Vec3& p) { p = random.in_cube(1); });
  EXPECT_TRUE(is_refitted(*tree_of(second, tree_of(first), 1e6)));
  const auto built = tree_of(second, tree_of(first), 1.2);
  EXPECT_FALSE(is_refitted(*built));
  EXPECT_EQ(cost(*built), cost(*tree_of(second)));
  // The cost is compared with that of the last build, however many refits followed it.
  Scene twisted = first;
  auto tree = tree_of(first);
  int builds = 0;
  for (int frame = 0; frame < 30; ++frame) {
    for_each_point(twisted, [&](Vec3& p) { p += random.in_cube(0.01F); });
    tree = tree_of(twisted, tree, 1.2);
    builds += !is_refitted(*tree);
    EXPECT_LE(cost(*tree), 1.3 * cost(*tree_of(twisted)));
  }
  EXPECT_GT(builds, 0);
  EXPECT_LT(builds, 15);
}

TEST(RefitTree, IsNotMadeWhereATreeOfOtherPrimitivesWouldBe) {
  const Scene still = mixed();
  const auto refits = [&](const auto& change) {
    Scene changed = still;
    change(changed);
    return is_refitted(*tree_of(changed, tree_of(still)));
  };
  const auto mesh = [](Scene& scene) -> Mesh& { return std::get<Mesh>(scene.objects[0].shape); };
  EXPECT_TRUE(refits([](Scene&) {}));
  EXPECT_TRUE(refits([](Scene& s) { std::get<Sphere>(s.objects[5].shape).radius = 2; }));
  EXPECT_TRUE(refits([&](Scene& s) { mesh(s).triangles.edit()[3][1] += 100; }));
  EXPECT_FALSE(refits([&](Scene& s) { mesh(s).triangles.edit()[3] = {0, 0, 0}; }));  // a point
  EXPECT_FALSE(refits([&](Scene& s) { mesh(s).triangles.edit()[3] = mesh(s).triangles[4]; }));
  EXPECT_FALSE(refits([&](Scene& s) { mesh(s).triangles.edit().back() = {0, 1, 2}; }));
  Scene one = still, other = still;  // as many duplicates, but of different triangles
  mesh(one).triangles.edit()[3] = mesh(one).triangles[4];
  mesh(other).triangles.edit()[5] = mesh(other).triangles[6];
  EXPECT_FALSE(is_refitted(*tree_of(other, tree_of(one))));
  EXPECT_FALSE(refits([](Scene& s) { s.objects[5].shape = Plane{}; }));
  EXPECT_FALSE(refits([](Scene& s) { std::get<Sphere>(s.objects[5].shape).radius = -1; }));
  EXPECT_FALSE(refits([](Scene& s) { std::get<Plane>(s.objects[2].shape).normal = Vec3(0); }));
  EXPECT_FALSE(refits([](Scene& s) { std::get<Triangle>(s.objects[3].shape) = {{}, {1, 0, 0}}; }));
}

// As the trees of pictures with points or line segments, which are triangles that are empty where
// they are invisible.
TEST(RefitTree, OfPrimitivesThatNoLongerExistIsBuiltAnew) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (const bool are_triangles : {true, false}) {
    const auto shape = [&](float x) -> Shape {
      if (are_triangles) return Triangle{{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}};
      return Sphere{{x + 0.25F, 0.25F, 0}, 0.2F};
    };
    std::vector<Shape> shapes(100, shape(kNaN)), later;
    for (int i = 0; i < 40; ++i) later.push_back(shape(2 * static_cast<float>(i)));
    shapes.insert(shapes.end(), later.begin(), later.end());
    const Scene before = scene_of(shapes), after = scene_of(later);
    const Bvh previous(before), bvh(after, {.previous = previous.tree()});
    for (int i = 0; i < 40; ++i) {
      const auto hit =
          bvh.intersect({.o = {2 * static_cast<float>(i) + 0.25F, 0.25F, 1}, .d = {0, 0, -1}});
      ASSERT_TRUE(hit.has_value());
      EXPECT_EQ(hit->id, static_cast<PrimitiveId>(i));
    }
  }
}

TEST(RefitTree, OfTrianglesThatMoveApartIsBuiltAnew) {
  const Mesh sphere = generated::displaced_sphere(2000);
  Mesh apart;  // each triangle has vertices of its own, at the positions of its neighbors' vertices
  for (std::uint32_t i = 0; i < sphere.triangles.size(); ++i) {
    for (const std::uint32_t corner : sphere.triangles[i])
      apart.positions.push_back(sphere.positions[corner]);
    apart.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Scene first = scene_of({apart});
  Scene second = first;
  Random random(5);
  Vec3 way(0);
  std::size_t points = 0;
  for_each_point(second, [&](Vec3& p) {
    if (points++ % 3 == 0) way = random.in_cube(0.1F);
    p += way;
  });
  const auto built = tree_of(second, tree_of(first));
  EXPECT_FALSE(is_refitted(*built));
  expect_whole(*built, Primitives(second), *tree_of(second));
  EXPECT_TRUE(is_refitted(*tree_of(first, built)));  // the blocks have room for all vertices
}

TEST(RefitTree, PositionsThatAreNotFiniteAreRefused) {
  Scene scene = scene_of({generated::displaced_sphere(2000)});
  const PreparedScene first(scene);
  std::get<Mesh>(scene.objects[0].shape).positions.edit()[5].y = std::nanf("");
  EXPECT_THROW(validate(scene), Error);
  // PreparedScene treats triangles with a non-finite vertex as empty.
  const PreparedScene second(scene, {.tables = first.tables()}), fresh(scene);
  Random random(4);
  expect_same_answers(fresh.bvh(), second.bvh(), rays_in(first.scene(), random, 300));
}

}  // namespace
}  // namespace microtrace
