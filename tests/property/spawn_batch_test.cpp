// Checks that Bvh::spawn_origins gives the same bits as Bvh::spawn_origin for any batch.

#include "accel/kernels/dispatch.hpp"
#include "exact/first_hit.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/effort.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

using Origins = std::vector<std::optional<Vec3>>;

bool are_same_bits(const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  return a.has_value() == b.has_value() &&
         (!a || (bits(a->x) == bits(b->x) && bits(a->y) == bits(b->y) && bits(a->z) == bits(b->z)));
}

testing::AssertionResult same(const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
  if (are_same_bits(a, b)) return testing::AssertionSuccess();
  const auto show = [](const std::optional<Vec3>& v) {
    std::array<char, 100> text{};
    if (v) std::snprintf(text.data(), text.size(), "(%a, %a, %a)", v->x, v->y, v->z);
    return v ? std::string(text.data()) : std::string("none");
  };
  return testing::AssertionFailure() << show(a) << " is not " << show(b);
}

/// A ray that hits primitive `id` of a scene.
struct Known {
  Ray ray;
  PrimitiveId id;
};

float signed_zero(Random& random) {
  return random.one_in(2) ? 0.0F : -0.0F;
}

/// Makes some coordinates zero with a random sign, tiny, or close to a power of two.
Vec3 with_odd_coordinates(Random& random, Vec3 v) {
  for (int k = 0; k < 3; ++k) {
    switch (random.between(0, 11)) {
      case 0:
        v[k] = signed_zero(random);
        break;
      case 1:
        v[k] = random.any_float(-149, -120);
        break;
      case 2:
        v[k] = moved(random.power_of_two(-4, 4), random.between(-2, 2));
        break;
      default:
        break;
    }
  }
  return v;
}

Vec3 direction(Random& random, const Ray& ray) {
  switch (random.between(0, 5)) {
    case 0:
      return -ray.d;
    case 1:
      return ray.d;
    case 2:
      return with_odd_coordinates(random, random.on_grid(1));
    case 3:
      return random.in_cube(1) * random.power_of_two(-60, 60);
    default:
      return with_odd_coordinates(random, random.in_cube(1));
  }
}

void add_shape(Scene& scene, const Shape& shape) {
  scene.objects.push_back({.name = "", .shape = shape});
}

/// Rays that leave a surface must have the same results whether or not the query names the
/// primitive that they leave.
void check_rays(const Bvh& bvh, const std::vector<Bvh::Spawn>& spawns, const Origins& origins) {
  std::vector<Ray> rays;
  std::vector<PrimitiveId> left;
  for (std::size_t i = 0; i < spawns.size(); ++i) {
    if (!origins[i]) continue;
    rays.push_back({.o = *origins[i], .t_min = 0, .d = spawns[i].direction});
    left.push_back(spawns[i].hit.id);
  }
  std::vector<std::optional<Hit>> hits(rays.size());
  bvh.intersect(rays, hits, left);
  const auto occluded = std::make_unique<bool[]>(rays.size());
  bvh.occluded(rays, std::span(occluded.get(), rays.size()), left);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::optional<Hit> alone = bvh.intersect(rays[i]);
    EXPECT_EQ(occluded[i], alone.has_value()) << i;
    EXPECT_EQ(hits[i].has_value(), alone.has_value()) << i;
    if (!hits[i] || !alone) continue;
    EXPECT_EQ(hits[i]->id, alone->id) << i;
    EXPECT_EQ(hits[i]->t, alone->t) << i;
  }
}

/// Computes the origins of each hit for several directions: in a batch, one by one with another
/// kind of tree, and in a batch of another order.
std::size_t check(Random& random, const Scene& scene, const std::vector<Known>& hits) {
  std::vector<Bvh::Spawn> spawns;
  for (const Known& known : hits) {
    for (int i = random.between(1, 4); i > 0; --i)
      spawns.push_back({.ray = &known.ray,
                        .hit = {.id = known.id, .t = 0},
                        .direction = direction(random, known.ray)});
  }
  const auto kernels = kRayKernels.available();
  setenv("MICROTRACE_ISA", kernels[random.bits() % kernels.size()]->name, 1);
  const Bvh bvh(scene), other(scene, {.fast_build = true});
  unsetenv("MICROTRACE_ISA");
  Origins together(spawns.size());
  bvh.spawn_origins(spawns, together);
  std::size_t found = 0;
  for (std::size_t i = 0; i < spawns.size(); ++i) {
    const auto alone = other.spawn_origin(*spawns[i].ray, spawns[i].hit, spawns[i].direction);
    EXPECT_TRUE(same(together[i], alone)) << i;
    found += alone ? 1 : 0;
    for (int k = 0; alone && k < 3; ++k)
      EXPECT_FALSE((*alone)[k] == 0 && std::signbit((*alone)[k]));
  }
  check_rays(bvh, spawns, together);
  std::vector<std::size_t> order(spawns.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::minstd_rand(random.bits()));
  std::vector<Bvh::Spawn> permuted;
  for (const std::size_t i : order) permuted.push_back(spawns[i]);
  Origins answers(permuted.size());
  bvh.spawn_origins(permuted, answers);
  for (std::size_t i = 0; i < order.size(); ++i)
    EXPECT_TRUE(same(answers[i], together[order[i]])) << order[i];
  return found;
}

/// The number of shapes to test, as a fraction of MICROTRACE_TRAVERSAL_RAYS, and the maximum number
/// of shapes per scene.
struct Effort {
  double share;
  int most;
};

/// Tests rays that hit one shape each, in scenes of one or several shapes. Returns the fraction of
/// queries that have a result.
template <class MakeCase>
double check_cases(std::uint64_t seed, const Effort& effort, MakeCase make_case) {
  Random random = traversal::announced_random(seed);
  const std::size_t cases = traversal::ray_count(effort.share);
  std::size_t answers = 0, questions = 0;
  for (std::size_t done = 0; done < cases && !testing::Test::HasFailure();) {
    Scene scene;
    std::vector<Known> hits;
    const int shapes = random.one_in(2) ? 1 : random.between(2, effort.most);
    for (int i = 0; i < shapes; ++i) {
      const auto [line, shape] = make_case(random);
      const auto id = static_cast<PrimitiveId>(scene.objects.size());
      add_shape(scene, shape);
      for (int k = random.between(1, 8); k > 0; --k) {
        Ray ray = line;
        if (k > 1) ray.o = with_odd_coordinates(random, random.jitter(line.o, 1 << (2 * k)));
        if (k > 2) ray.d = with_odd_coordinates(random, random.jitter(line.d, 1 << (2 * k)));
        if (exact::is_valid(ray) && exact::first_hit(shape, ray)) hits.push_back({ray, id});
      }
      ++done;
    }
    answers += check(random, scene, hits);
    questions += hits.size();
  }
  return double(answers) / double(questions);
}

TEST(SpawnBatch, Triangles) {
  for (const TriangleKind kind : kTriangleKinds) {
    SCOPED_TRACE(name(kind));
    const double answered = check_cases(80, {.share = 0.002, .most = 40}, [&](Random& random) {
      return triangle_case(random, kind);
    });
    EXPECT_GE(answered, kind == TriangleKind::degenerate ? 0 : 0.25);
  }
}

template <class MakeCase>
void check_all_kinds(std::uint64_t seed, const Effort& effort, MakeCase make_case) {
  for (const ShapeKind kind : kShapeKinds) {
    SCOPED_TRACE(name(kind));
    const auto make = [&](Random& random) { return make_case(random, kind); };
    EXPECT_GT(check_cases(seed, effort, make), 0.25);
  }
}

TEST(SpawnBatch, Planes) {
  check_all_kinds(81, {.share = 0.00005, .most = 4}, plane_case);
}
TEST(SpawnBatch, Discs) {
  check_all_kinds(82, {.share = 0.002, .most = 40}, disc_case);
}
TEST(SpawnBatch, Spheres) {
  check_all_kinds(83, {.share = 0.001, .most = 40}, sphere_case);
}
TEST(SpawnBatch, Quadrics) {
  check_all_kinds(84, {.share = 0.00003, .most = 4}, quadric_case);
}

/// Returns shapes of all kinds on a grid with this spacing. Many of them touch.
Scene touching_shapes(Random& random, float spacing, const Vec3& center) {
  Scene scene;
  for (int i = random.one_in(2) ? random.between(2, 16) : random.between(17, 80); i > 0; --i) {
    const Vec3 at = center + random.on_grid(3, spacing);
    Vec3 normal = random.one_in(2) ? random.on_grid(1) : random.in_cube(1);
    if (random.one_in(4)) normal = with_odd_coordinates(random, normal);
    switch (random.between(0, 15)) {
      case 0:
        add_shape(scene, Plane{.point = at, .normal = normal});
        break;
      case 1:
      case 2:
        add_shape(scene, Disc{.center = at, .normal = normal, .radius = 2 * spacing});
        break;
      case 3:
      case 4:
        add_shape(scene, Sphere{.center = at, .radius = spacing * float(random.between(1, 3))});
        break;
      default: {
        const Vec3 b = at + random.on_grid(2, spacing), c = at + random.on_grid(2, spacing);
        add_shape(scene,
                  Triangle{random.jitter(at, 1), b, random.one_in(4) ? random.jitter(c, 2) : c});
      }
    }
  }
  return scene;
}

// Tests all hits of rays, including hidden ones. Many hits are at vertices, on edges and at points
// where shapes touch.
TEST(SpawnBatch, TouchingShapes) {
  Random random = traversal::announced_random(85);
  std::size_t answers = 0;
  const std::size_t scenes = traversal::ray_count(0.0002);
  for (std::size_t round = 0; round < scenes && !HasFailure(); ++round) {
    const float spacing = random.one_in(2) ? 1 : random.power_of_two(-60, 30);
    const Vec3 center = random.one_in(2) ? Vec3(0) : random.in_cube(1e7F) * spacing;
    const Scene scene = touching_shapes(random, spacing, center);
    const Bvh bvh(scene);
    std::vector<Known> hits;
    for (int i = 0; i < 60; ++i) {
      Ray ray{.o = center + random.on_grid(5, spacing), .d = random.on_grid(2)};
      if (random.one_in(2)) ray.o = center + random.in_cube(5) * spacing;
      if (random.one_in(2)) ray.d = with_odd_coordinates(random, random.in_cube(1));
      for (auto hit = bvh.intersect(ray); hit; hit = bvh.next(ray, *hit))
        hits.push_back({.ray = ray, .id = hit->id});
    }
    answers += check(random, scene, hits);
  }
  EXPECT_GT(answers, 20 * scenes);
}

}  // namespace
}  // namespace microtrace
