// Compares the tests of parallelograms, in trees of a few triangles, with exact arithmetic.

#include "accel/few_triangles.hpp"

#include "accel/build/tree.hpp"
#include "accel/kernel_rays.hpp"
#include "accel/large_triangles.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/effort.hpp"
#include "support/hit_by_definition.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/primitives.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using adversarial::Random;

constexpr std::size_t kRays = 480;

/// The corners of a parallelogram, of which d has been moved by some rounding errors.
struct Corners {
  Vec3 a, b, c, d;
};

Corners random_corners(Random& random, int most_errors) {
  const float scale = random.power_of_two(-3, 3);
  const Vec3 a = random.one_in(4) ? Vec3(0) : random.in_cube(4);
  Vec3 e1 = scale * random.in_cube(1), e2 = scale * random.in_cube(1);
  if (random.one_in(2)) {  // along axes
    const int axis = random.between(0, 2);
    const float first = e1.x, second = e2.x;
    e1 = e2 = Vec3(0);
    e1[axis] = first;
    e2[(axis + random.between(1, 2)) % 3] = second;
  }
  if (random.one_in(3)) e2 *= random.power_of_two(-6, 0);
  const Vec3 b = a + e1, c = a + e2;
  Vec3 d(DVec3(b) + DVec3(c) - DVec3(a));
  const float unit = 0x1p-24F * std::max({std::abs(e1.x), std::abs(e1.y), std::abs(e1.z)});
  for (int k = 0; k < 3; ++k)
    d[k] += unit * static_cast<float>(random.between(-most_errors, most_errors));
  return {.a = a, .b = b, .c = c, .d = d};
}

Triangle turned(Random& random, Triangle t) {
  for (int i = random.between(0, 2); i > 0; --i) t = {.a = t.b, .b = t.c, .c = t.a};
  if (random.one_in(2)) std::swap(t.b, t.c);
  return t;
}

/// A scene of parallelograms, each of two triangles, and of a few single triangles if there are
/// several. Many of the parallelograms are exact.
struct Parallelograms {
  std::vector<Corners> corners;
  Scene scene;

  Parallelograms(Random& random, int count, int most_errors) {
    for (int i = 0; i < count; ++i) {
      const Corners& p =
          corners.emplace_back(random_corners(random, random.one_in(2) ? 0 : most_errors));
      add(turned(random, {.a = p.a, .b = p.b, .c = p.c}));
      if (count == 1 || !random.one_in(8)) add(turned(random, {.a = p.d, .b = p.b, .c = p.c}));
    }
  }

 private:
  void add(const Triangle& triangle) { scene.objects.push_back({.name = "", .shape = triangle}); }
};

/// Returns a point on an edge, on the diagonal, at a corner or within, moved by rounding errors.
Vec3 random_target(Random& random, const Corners& p) {
  const std::array<std::pair<Vec3, Vec3>, 6> segments = {
      {{p.a, p.b}, {p.a, p.c}, {p.d, p.b}, {p.d, p.c}, {p.b, p.c}, {p.a, p.d}}};
  const auto& [from, to] = segments[static_cast<std::size_t>(random.between(0, 5))];
  const double s = random.one_in(4) ? random.between(0, 1) : random.unit();
  return random.jitter(Vec3(DVec3(from) + s * (DVec3(to) - DVec3(from))),
                       1 << random.between(0, 4));
}

Ray random_ray(Random& random, const Parallelograms& all) {
  const auto& corners = all.corners;
  const auto some = [&]() -> const Corners& {
    return corners[static_cast<std::size_t>(
        random.between(0, static_cast<int>(corners.size()) - 1))];
  };
  const Vec3 target = random_target(random, some());
  Vec3 o = random.one_in(4) ? random_target(random, some())
                            : target + random.power_of_two(-8, 4) * random.in_cube(1);
  const int axis = random.between(0, 2);
  if (random.one_in(5)) o[axis] = target[axis];  // often in the plane of a rectangle
  Vec3 d = target - o;
  if (random.one_in(10)) {
    d[axis] = random.power_of_two(-126, -90);
    if (random.one_in(2)) d[axis] = -d[axis];
  }
  return {.o = o,
          .t_min = random.one_in(8) ? 1.0F : 0.0F,
          .d = d,
          .t_max = random.one_in(8) ? 1 : INFINITY};
}

/// Casts random rays, and compares their hits with those by definition. Adds their number to
/// `hits`.
void check_rays(Random& random, const Parallelograms& all, std::size_t& hits) {
  const Bvh bvh(all.scene);
  const Primitives primitives(all.scene);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < kRays; ++i) rays.push_back(random_ray(random, all));
  std::vector<std::optional<Hit>> found(kRays);
  bvh.intersect(rays, found);
  const auto occluded = std::make_unique<bool[]>(kRays);
  bvh.occluded(rays, std::span(occluded.get(), kRays));
  for (std::size_t i = 0; i < kRays; ++i) {
    const std::optional<Hit> expected = hit_by_definition(primitives, rays[i]);
    hits += expected ? 1 : 0;
    ASSERT_TRUE(same(found[i], expected)) << "ray " << i;
    ASSERT_EQ(occluded[i], expected.has_value()) << "ray " << i;
  }
}

std::size_t joined_triangles(const FewTriangles& few) {
  return 2 * static_cast<std::size_t>(few.count - few.ends[FewTriangles::kOblique]);
}

TEST(FewTriangles, RaysThroughParallelogramsHaveTheirExactHits) {
  with_each_kernel([] {
    Random random = traversal::announced_random(61);
    const std::size_t rounds = traversal::ray_count(0.1) / kRays;
    std::size_t triangles = 0, joined = 0, rectangles = 0, hits = 0;
    for (std::size_t round = 0; round < rounds; ++round) {
      const Parallelograms all(random, random.between(1, 5), 1 << random.between(0, 4));
      const Primitives primitives(all.scene);
      triangles += primitives.count();
      const auto few = few_triangles(build_tree(primitives, {}));
      joined += joined_triangles(*few);
      rectangles += static_cast<std::size_t>(few->ends[FewTriangles::kOblique - 1]);
      ASSERT_NO_FATAL_FAILURE(check_rays(random, all, hits)) << "round " << round;
    }
    EXPECT_GT(joined, triangles / 2);
    EXPECT_GT(rectangles, rounds / 2);
    EXPECT_GT(hits, rounds * kRays / 4);
  });
}

/// Adds a cluster of small triangles at a random point of the first parallelogram.
void add_small_triangles(Random& random, int count, Parallelograms& all) {
  const Vec3 center = random_target(random, all.corners[0]);
  for (int i = 0; i < count; ++i) {
    const Vec3 at = center + 0x1p-3F * random.in_cube(1);
    const Vec3 b = at + 0x1p-5F * random.in_cube(1), c = at + 0x1p-5F * random.in_cube(1);
    if (i % 8 == 0) all.corners.push_back({.a = at, .b = b, .c = c, .d = c});  // of some targets
    all.scene.objects.push_back({.name = "", .shape = Triangle{.a = at, .b = b, .c = c}});
  }
}

TEST(FewTriangles, LargeTrianglesAmongManyHaveTheirExactHits) {
  with_each_kernel([] {
    Random random = traversal::announced_random(63);
    // In builds with sanitizers, the scenes of a share of the rays are too few to be typical.
    const std::size_t rounds = std::max<std::size_t>(traversal::ray_count(0.02) / kRays, 16);
    std::size_t with_large = 0, hits = 0;
    for (std::size_t round = 0; round < rounds; ++round) {
      Parallelograms all(random, 4, 1 << random.between(0, 4));
      add_small_triangles(random, 200, all);
      if (random.one_in(2))
        all.scene.objects.push_back({.name = "", .shape = Sphere{random.in_cube(4), 0.5F}});
      const Primitives primitives(all.scene);
      const LargeTriangles large = large_triangles(build_tree(primitives, {}));
      if (large.triangles) {
        ++with_large;
        EXPECT_LT(large.triangles->count, 40);
      }
      ASSERT_NO_FATAL_FAILURE(check_rays(random, all, hits)) << "round " << round;
    }
    EXPECT_GT(with_large, rounds / 2);
    EXPECT_GT(hits, rounds * kRays / 4);
  });
}

/// Casts rays through triangles that few_triangles() has joined with the given growth of error
/// bounds.
class JoinedTriangles {
 public:
  JoinedTriangles(const Scene& scene, double most_growth)
      : primitives_(scene), few_(few_triangles(tree_, most_growth)) {}

  [[nodiscard]] const FewTriangles& few() const { return *few_; }

  void check(const Kernels& kernels, const std::vector<Ray>& rays) {
    auto stream = std::make_unique<KernelStream>();
    for (const Ray& ray : rays) {
      const auto i = static_cast<std::size_t>(stream->count++);
      for (int k = 0; k < 3; ++k) stream->o[k][i] = ray.o[k], stream->d[k][i] = ray.d[k];
      stream->t_min[i] = ray.t_min;
      stream->best_hi[i] = ray.t_max;
      stream->omitted_id[i] = kNoPrimitive;
    }
    kernels.prepare_stream(*stream);
    rays_ = &rays;
    const StreamFallback slow{
        .context = this, .consider = [](void* self, int i, std::uint32_t id, ClosestSoFar& best) {
          const auto& all = *static_cast<const JoinedTriangles*>(self);
          HitResolver(all.primitives_, (*all.rays_)[static_cast<std::size_t>(i)])
              .consider(id, best);
        }};
    const TreeView view{.nodes = nullptr,
                        .blocks = tree_.blocks.data(),
                        .others = nullptr,
                        .root = tree_.root,
                        .few = few_.get()};
    kernels.closest_of_stream(view, *stream, slow);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::optional<Hit> expected = hit_by_definition(primitives_, rays[i]);
      ASSERT_EQ(stream->best_id[i], expected ? expected->id : kNoPrimitive) << "ray " << i;
      if (!expected) continue;
      EXPECT_LE(stream->best_lo[i], expected->t);
      EXPECT_GE(stream->best_hi[i], expected->t);
    }
  }

 private:
  const Primitives primitives_;
  const Tree tree_ = build_tree(primitives_, {});
  const std::unique_ptr<const FewTriangles> few_;
  const std::vector<Ray>* rays_ = nullptr;
};

// With rounding errors alone, the bounds of VolumeTest nearly always cover those of the fourth
// corner too.
TEST(FewTriangles, DistancesOfTheFourthCornerAreCovered) {
  with_each_kernel([] {
    Random random = traversal::announced_random(62);
    const std::size_t rounds = traversal::ray_count(0.1) / kRays;
    for (std::size_t round = 0; round < rounds; ++round) {
      const Parallelograms all(random, 1, 1 << 12);
      JoinedTriangles joined(all.scene, 0x1p30);
      ASSERT_EQ(joined_triangles(joined.few()), 2U);
      std::vector<Ray> rays;
      while (rays.size() < kRays) {
        const Ray ray = random_ray(random, all);
        if (kernel_t_scale(ray) == 1) rays.push_back(ray);
      }
      joined.check(kRayKernels.best(), rays);
      if (HasFailure()) FAIL() << "in round " << round;
    }
  });
}

/// The triangle (0, 0, 0), (1, 0, 0), (0, 0, 1), and another one with this vertex beyond the
/// diagonal.
std::unique_ptr<const FewTriangles> quadrilateral(const Vec3& fourth) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 0, 1);
  Scene scene;
  scene.objects.push_back({.name = "", .shape = Triangle{.a = a, .b = b, .c = c}});
  scene.objects.push_back({.name = "", .shape = Triangle{.a = c, .b = b, .c = fourth}});
  return few_triangles(build_tree(Primitives(scene), {}));
}

TEST(FewTriangles, OnlyParallelogramsAreJoined) {
  const auto joined = [](const Vec3& fourth) { return joined_triangles(*quadrilateral(fourth)); };
  EXPECT_EQ(joined({1, 0, 1}), 2U);
  EXPECT_EQ(joined({1 + 0x1p-22F, 0, 1}), 2U);
  EXPECT_EQ(joined({1 + 0x1p-20F, 0, 1}), 0U);
  EXPECT_EQ(joined({1, 0x1p-20F, 1}), 0U);
  EXPECT_EQ(joined({-1, 0, -1}), 0U);
}

TEST(FewTriangles, RectanglesAreExact) {
  const auto axis = [](const Vec3& fourth) { return quadrilateral(fourth)->facets[0].axis; };
  EXPECT_EQ(axis({1, 0, 1}), 1);
  EXPECT_EQ(axis({1 + 0x1p-22F, 0, 1}), FewTriangles::kOblique);
  EXPECT_EQ(axis({1, 0x1p-30F, 1}), FewTriangles::kOblique);
}

}  // namespace
}  // namespace microtrace
