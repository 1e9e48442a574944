// Tests changes that must not affect results: the order of a triangle's vertices and of primitives,
// mirrored or permuted axes, scaling or translating by powers of two, the build method, and its
// number of threads.

#include "exact/first_hit.hpp"
#include "support/cases/adversarial_scenes.hpp"
#include "support/effort.hpp"

#include <microtrace/bvh.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

using Answers = std::vector<std::optional<Hit>>;
using Move = std::function<Vec3(Vec3)>;

/// Returns the scene with its points and normals transformed and its lengths scaled.
Scene moved_scene(Scene scene, const Move& point, const Move& normal, float length) {
  for (Object& object : scene.objects) {
    if (auto* mesh = std::get_if<Mesh>(&object.shape)) {
      for (Vec3& p : mesh->positions.edit()) p = point(p);
    } else if (auto* sphere = std::get_if<Sphere>(&object.shape)) {
      *sphere = {point(sphere->center), sphere->radius * length};
    } else if (auto* disc = std::get_if<Disc>(&object.shape)) {
      *disc = {point(disc->center), normal(disc->normal), disc->radius * length};
    } else if (auto* plane = std::get_if<Plane>(&object.shape)) {
      *plane = {point(plane->point), normal(plane->normal)};
    }
  }
  return scene;
}

Answers answers(const Scene& scene, const std::vector<Ray>& rays, const BvhOptions& options = {}) {
  Answers hits(rays.size());
  Bvh(scene, options).intersect(rays, hits);
  return hits;
}

struct LawCase {
  Scene scene;
  std::vector<Ray> rays;
};

LawCase random_case(Random& random, SceneKind kind) {
  LawCase c{.scene = random_scene(random, kind), .rays = {}};
  for (int i = 0; i < 200; ++i) {
    const Vec3 o = i % 16 == 0 || random.one_in(4) ? origin(random, c.scene) : c.rays.back().o;
    c.rays.push_back(random_ray(random, c.scene, o));
  }
  return c;
}

void expect_equal(const Answers& a, const Answers& b, float scale = 1) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].has_value(), b[i].has_value()) << "ray " << i;
    if (!a[i]) continue;
    ASSERT_EQ(a[i]->id, b[i]->id) << "ray " << i;
    const float t = a[i]->t * scale;
    const auto has_all_bits = [](float x) { return std::isnormal(x) || x == 0; };
    if (!has_all_bits(t) || !has_all_bits(a[i]->t))
      continue;  // subnormal numbers are rounded differently
    ASSERT_EQ(t, b[i]->t) << "ray " << i;
  }
}

class Laws : public testing::TestWithParam<SceneKind> {
 protected:
  /// Calls f(random, case) for several scenes of the kind.
  void for_each_case(std::uint64_t test, const std::function<void(Random&, LawCase)>& f) {
    Random random = traversal::announced_random(50 + test);
    const std::size_t rounds = traversal::ray_count(0.02) / 200;
    for (std::size_t round = 0; round < rounds && !HasFatalFailure(); ++round) {
      SCOPED_TRACE(round);
      f(random, random_case(random, GetParam()));
    }
  }
};

std::string kind_name(const testing::TestParamInfo<SceneKind>& kind) {
  return name(kind.param);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Laws, testing::ValuesIn(kSceneKinds), kind_name);

// Kinds of scenes that can be scaled without leaving the float32 range.
using LawsOfSize = Laws;
INSTANTIATE_TEST_SUITE_P(Scenes, LawsOfSize,
                         testing::Values(SceneKind::soup, SceneKind::lattice,
                                         SceneKind::huge_and_tiny, SceneKind::far_from_zero,
                                         SceneKind::slivers, SceneKind::walls),
                         kind_name);

// Kinds of scenes whose coordinates have only a few significant bits.
using LawsOfPlace = Laws;
INSTANTIATE_TEST_SUITE_P(Scenes, LawsOfPlace, testing::Values(SceneKind::lattice, SceneKind::walls),
                         kind_name);

TEST_P(Laws, OrderOfVerticesHasNoEffect) {
  for_each_case(1, [](Random& random, const LawCase& c) {
    Scene turned = c.scene;
    for (Object& object : turned.objects) {
      auto* mesh = std::get_if<Mesh>(&object.shape);
      if (mesh == nullptr) continue;
      for (auto& triangle : mesh->triangles.edit()) {
        std::rotate(triangle.begin(), triangle.begin() + random.between(0, 2), triangle.end());
        if (random.one_in(2)) std::swap(triangle[0], triangle[1]);
      }
    }
    expect_equal(answers(c.scene, c.rays), answers(turned, c.rays));
  });
}

// If several hits have equal t, another primitive may be returned, but t must not change.
TEST_P(Laws, OrderOfPrimitivesOnlyDecidesTies) {
  for_each_case(2, [](Random& random, const LawCase& c) {
    Scene shuffled = c.scene;
    std::vector<std::size_t> old_place(
        shuffled.objects.size());  // the previous index of each object
    std::iota(old_place.begin(), old_place.end(), 0U);
    for (std::size_t i = old_place.size() - 1; i > 0; --i)
      std::swap(old_place[i],
                old_place[static_cast<std::size_t>(random.between(0, static_cast<int>(i)))]);
    for (std::size_t i = 0; i < old_place.size(); ++i) {
      shuffled.objects[i] = c.scene.objects[old_place[i]];
      if (auto* mesh = std::get_if<Mesh>(&shuffled.objects[i].shape))
        std::ranges::reverse(mesh->triangles.edit());
    }
    const Primitives before(c.scene), after(shuffled);
    const auto old_id = [&](PrimitiveId id) {
      const std::size_t place = after.object_index(id);
      PrimitiveId first = 0;
      before.for_each([&](PrimitiveId other, const auto&) {
        if (before.object_index(other) == old_place[place] && before.first_id(other) == other)
          first = other;
      });
      const auto* mesh = std::get_if<Mesh>(&shuffled.objects[place].shape);
      const PrimitiveId within = id - after.first_id(id);
      if (mesh == nullptr) return first;
      return first + static_cast<PrimitiveId>(mesh->triangles.size()) - 1 - within;
    };
    const Answers a = answers(c.scene, c.rays), b = answers(shuffled, c.rays);
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a[i].has_value(), b[i].has_value()) << "ray " << i;
      if (!a[i]) continue;
      ASSERT_EQ(a[i]->t, b[i]->t) << "ray " << i;
      const PrimitiveId now = old_id(b[i]->id);
      ASSERT_LE(a[i]->id, now) << "ray " << i;
      if (a[i]->id == now) continue;
      const auto root = [&](PrimitiveId id) {
        return *before.visit(id,
                             [&](const auto& shape) { return exact::first_hit(shape, c.rays[i]); });
      };
      ASSERT_TRUE(root(a[i]->id) == root(now)) << "ray " << i;
    }
  });
}

TEST_P(Laws, MirroredAndPermutedAxesHaveNoEffect) {
  for_each_case(3, [](Random& random, LawCase c) {
    const int first = random.between(0, 2);
    const bool mirrored = random.one_in(2);
    const Move turn = [&](Vec3 p) {
      const Vec3 q(p[first], p[(first + 1) % 3], p[(first + 2) % 3]);
      return mirrored ? Vec3(q.y, q.x, -q.z) : Vec3(-q.x, q.y, -q.z);
    };
    const Answers expected = answers(c.scene, c.rays);
    for (Ray& ray : c.rays) {
      ray.o = turn(ray.o);
      ray.d = turn(ray.d);
    }
    expect_equal(expected, answers(moved_scene(c.scene, turn, turn, 1), c.rays));
  });
}

// The test uses only numbers that neither overflow nor underflow when they are scaled.
TEST_P(LawsOfSize, ScalingByPowersOfTwoHasNoEffect) {
  for_each_case(4, [](Random& random, LawCase c) {
    const bool exact =
        std::all_of(c.scene.objects.begin(), c.scene.objects.end(), [](const auto& o) {
          const auto* mesh = std::get_if<Mesh>(&o.shape);
          return mesh == nullptr ||
                 std::all_of(mesh->positions.begin(), mesh->positions.end(), [](const Vec3& p) {
                   const Vec3 there = p * 0x1p40F;
                   return there * 0x1p-40F == p && (p * 0x1p-40F) * 0x1p40F == p;
                 });
        });
    if (!exact) return;  // the second mesh may have any size
    const float size = random.power_of_two(-40, 40);
    // Scales t with the scene in half of the cases, and the directions in the other half.
    const bool scales_t = random.one_in(2);
    const float t_scale = scales_t ? size : 1, d_scale = scales_t ? 1 : size;
    std::vector<Ray> rays;
    for (Ray& ray : c.rays) {
      Ray s = ray;
      s.o *= size;
      s.d *= d_scale;
      s.t_min *= t_scale;
      s.t_max *= t_scale;
      const bool stays = s.o / size == ray.o && s.d / d_scale == ray.d &&
                         s.t_min / t_scale == ray.t_min && s.t_max / t_scale == ray.t_max;
      if (!stays) s = ray = {.d = Vec3(0)};
      rays.push_back(s);
    }
    const Answers expected = answers(c.scene, c.rays);
    const Scene scene = moved_scene(
        c.scene, [&](Vec3 p) { return p * size; }, [](Vec3 n) { return n; }, size);
    expect_equal(expected, answers(scene, rays), t_scale);
  });
}

TEST_P(LawsOfPlace, ExactTranslationHasNoEffect) {
  for_each_case(5, [](Random& random, LawCase c) {
    const auto fits = [](const Vec3& p) {
      return glm::abs(p.x) <= 64 && glm::abs(p.y) <= 64 && glm::abs(p.z) <= 64 &&
             p == (p + 0x1p14F) - 0x1p14F;
    };
    std::erase_if(c.scene.objects.edit(), [&](const Object& object) {
      const auto* mesh = std::get_if<Mesh>(&object.shape);
      return mesh != nullptr && !std::all_of(mesh->positions.begin(), mesh->positions.end(), fits);
    });
    std::erase_if(c.rays, [&](const Ray& ray) { return !fits(ray.o); });
    Vec3 by{0};
    for (int k = 0; k < 3; ++k) by[k] = (random.one_in(2) ? 1 : -1) * random.power_of_two(0, 13);
    const Answers expected = answers(c.scene, c.rays);
    const Scene scene = moved_scene(
        c.scene, [&](Vec3 p) { return p + by; }, [](Vec3 n) { return n; }, 1);
    for (Ray& ray : c.rays) ray.o += by;
    expect_equal(expected, answers(scene, c.rays));
  });
}

TEST_P(Laws, BuildOptionsHaveNoEffect) {
  for_each_case(6, [](Random& random, const LawCase& c) {
    const Answers expected = answers(c.scene, c.rays, {.threads = 1});
    const auto threads = static_cast<unsigned>(random.between(2, 5));
    expect_equal(expected, answers(c.scene, c.rays, {.threads = threads}));
    expect_equal(expected, answers(c.scene, c.rays, {.fast_build = true, .threads = threads}));
  });
}

}  // namespace
}  // namespace microtrace
