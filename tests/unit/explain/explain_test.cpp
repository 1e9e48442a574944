#include "support/cases/adversarial_scenes.hpp"

#include <microtrace/error.hpp>
#include <microtrace/explain.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace microtrace {
namespace {

using adversarial::Random;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Scene scene_of(std::vector<Shape> shapes) {
  Scene scene;
  for (Shape& shape : shapes) scene.objects.push_back({.name = "", .shape = std::move(shape)});
  return scene;
}

/// Returns true if the line of the ray may meet the primitive according to its numbers.
bool may_meet(const IntersectionNumbers& numbers) {
  if (const auto* n = std::get_if<QuadraticNumbers>(&numbers))
    return !n->roots.empty() || (n->a_sign == 0 && n->b_sign == 0 && n->c_sign == 0);
  if (const auto* n = std::get_if<PlaneNumbers>(&numbers)) return n->t || n->height_sign == 0;
  if (const auto* n = std::get_if<DiscNumbers>(&numbers))
    return n->ball ? !n->ball->roots.empty() : n->squared_distance && n->side <= 0;
  if (const auto* n = std::get_if<TriangleNumbers>(&numbers))
    return !place_in_triangle(*n).starts_with("outside");
  return false;
}

void expect_numbers_agree_with_hits(const Explanation& e) {
  for (const ExplainedHit& hit : e.hits) {
    EXPECT_TRUE(may_meet(hit.primitive.numbers));
    if (const auto* n = std::get_if<QuadraticNumbers>(&hit.primitive.numbers)) {
      const bool is_clipped = n->roots.empty();
      EXPECT_TRUE(is_clipped || std::ranges::find(n->roots, hit.exact_t) != n->roots.end());
    }
    EXPECT_EQ(static_cast<float>(hit.exact_t), hit.t) << hit.exact_t;
  }
  for (const ExplainedCrossing& crossing : e.crossings)
    EXPECT_TRUE(may_meet(crossing.primitive.numbers));
}

/// Checks an explanation against the queries of the library.
void expect_right(const PreparedScene& scene, const Ray& ray) {
  const Explanation e = explain(scene, ray, {.max_misses = 500});
  std::size_t count = 0;
  for (auto hit = scene.intersect(ray); hit; hit = scene.next(ray, *hit), ++count) {
    ASSERT_LT(count, e.hits.size());
    EXPECT_EQ(e.hits[count].primitive.id, hit->id);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(e.hits[count].t), std::bit_cast<std::uint32_t>(hit->t));
  }
  EXPECT_EQ(e.hits.size(), count);
  EXPECT_EQ(e.hit_count, count);
  expect_numbers_agree_with_hits(e);
  if (!e.misses) return;
  for (const ExplainedMiss& miss : *e.misses) {
    EXPECT_FALSE(miss.reason.empty());
    if (!e.is_valid) continue;
    const Ray whole{.o = ray.o, .t_min = 0, .d = ray.d};
    Scene alone;
    scene.bvh().primitives().visit(miss.primitive.id, [&](const auto& shape) {
      alone.objects.push_back({.name = "", .shape = shape});
    });
    EXPECT_FALSE(Bvh(alone).intersect(whole)) << miss.reason;
  }
  EXPECT_TRUE(nlohmann::json::accept(explanation_json(e)));
}

TEST(Explain, AgreesWithTheQueriesOnDifficultScenes) {
  Random random(1);
  for (int i = 0; i < 24; ++i) {
    const PreparedScene scene(adversarial::random_scene(random));
    for (int k = 0; k < 3; ++k) {
      const Vec3 o = adversarial::origin(random, scene.scene());
      expect_right(scene, adversarial::random_ray(random, scene.scene(), o));
    }
    for (const Ray& ray : adversarial::unrelated_rays(random, scene.scene(), 2))
      expect_right(scene, ray);
  }
}

TEST(Explain, AgreesWithTheQueriesOnDifficultShapes) {
  Random random(2);
  for (int i = 0; i < 40; ++i) {
    for (const auto kind : adversarial::kShapeKinds) {
      const auto sphere = adversarial::sphere_case(random, kind);
      expect_right(PreparedScene(scene_of({sphere.shape})), sphere.ray);
      const auto plane = adversarial::plane_case(random, kind);
      expect_right(PreparedScene(scene_of({plane.shape})), plane.ray);
      const auto disc = adversarial::disc_case(random, kind);
      expect_right(PreparedScene(scene_of({disc.shape})), disc.ray);
      const auto quadric = adversarial::quadric_case(random, kind);
      expect_right(PreparedScene(scene_of({quadric.shape})), quadric.ray);
    }
    for (const auto kind : adversarial::kTriangleKinds) {
      const auto triangle = adversarial::triangle_case(random, kind);
      expect_right(PreparedScene(scene_of({triangle.shape})), triangle.ray);
    }
  }
}

TEST(Explain, NamesTheStageThatDecided) {
  const PreparedScene scene(scene_of({Triangle{.a = {0, 0, 0}, .b = {4, 0, 0}, .c = {0, 4, 0}}}));
  const auto stage = [&](const Ray& ray) {
    const Explanation e = explain(scene, ray);
    return (e.hits.empty() ? e.misses->front().primitive : e.hits.front().primitive).decided_by;
  };
  EXPECT_EQ(stage({.o = {1, 1, 1}}), Stage::float32);
  EXPECT_EQ(stage({.o = {9, 9, 1}}), Stage::float32);
  EXPECT_EQ(stage({.o = {1, 0x1p-40F, 1}}), Stage::float64);
  EXPECT_EQ(stage({.o = {1, 0, 1}}), Stage::grid);
  EXPECT_EQ(stage({.o = {1, 0, 1}, .d = {0x1p-149F, 0, -0x1p100F}}), Stage::dyadic);
  const PreparedScene ball(scene_of({Sphere{}}));
  EXPECT_EQ(explain(ball, {.o = {0, 0, 5}}).hits.front().primitive.decided_by, Stage::float64);
  EXPECT_EQ(explain(ball, {.o = {1, 0, 5}}).hits.front().primitive.decided_by, Stage::dyadic);
}

TEST(Explain, NamesHowTheOrderWasDecided) {
  const auto wall = [](float z) {
    return Triangle{.a = {-1, -1, z}, .b = {1, -1, z}, .c = {0, 1, z}};
  };
  const auto orders = [](const Scene& scene, const Vec3& d) {
    std::vector<OrderDecision> result;
    for (const ExplainedHit& hit : explain(PreparedScene(scene), {.o = {0, 0, 3}, .d = d}).hits)
      result.push_back(hit.order);
    return result;
  };
  using enum OrderDecision;
  const Vec3 straight(0, 0, -1);
  EXPECT_EQ(orders(scene_of({wall(0), wall(1)}), straight), (std::vector{first, bounds}));
  EXPECT_EQ(orders(scene_of({wall(0), wall(0)}), straight), (std::vector{first, tie}));
  EXPECT_EQ(orders(scene_of({wall(0), wall(0x1p-120F)}), straight), (std::vector{first, exact}));
}

TEST(Explain, AddsTheOriginOfTheScene) {
  Scene scene = scene_of({Sphere{}});
  scene.origin = DVec3(1000, 0, 0);
  const PreparedScene prepared(scene);
  const Explanation e = explain(prepared, {.o = {1000, 0, 5}, .d = {0, 0, -2}});
  ASSERT_EQ(e.hits.size(), 1);
  EXPECT_EQ(e.hits[0].t, 2);
  EXPECT_EQ(e.hits[0].distance, 4);
  EXPECT_EQ(e.hits[0].position, DVec3(1000, 0, 1));
  EXPECT_EQ(e.ray.o, Vec3(0, 0, 5));
  const Explanation pixel = explain(prepared, PerspectiveCamera{.pose = {.position = {0, 0, 5}}},
                                    {.width = 9, .height = 9}, 4.5, 4.5);
  ASSERT_EQ(pixel.hits.size(), 1);
  EXPECT_EQ(pixel.hits[0].position, DVec3(1000, 0, 1));
  EXPECT_EQ(pixel.hits[0].depth, 4);
}

TEST(Explain, RefusesPointsOutsideOfThePicture) {
  const PreparedScene scene(scene_of({Sphere{}}));
  const ImageSize size{.width = 4, .height = 3};
  for (const DVec2& at : {DVec2(-0.1, 1), DVec2(4.1, 1), DVec2(1, -0.1), DVec2(1, 3.1),
                          DVec2(std::nan(""), 1), DVec2(1, kInfinity)}) {
    EXPECT_THROW((void)explain(scene, PerspectiveCamera{}, size, at.x, at.y), Error);
  }
}

TEST(Explain, ExplainsInvalidRaysAndEmptyShapes) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  // GCC 13.2 can't compile an argument that contains this triangle.
  const Triangle infinite{.a = {kInfinity, 0, 0}, .b = {1, 0, 0}, .c = {0, 1, 0}};
  const PreparedScene scene(
      scene_of({Sphere{.radius = -1}, Sphere{.center = {0, nan, 0}}, Plane{.normal = Vec3(0)},
                Disc{.radius = -1}, infinite, Quadric{.a = nan}}));
  for (const Ray& ray : {Ray{}, Ray{.d = Vec3(0)}, Ray{.o = {nan, 0, 0}}, Ray{.t_max = -1}}) {
    const Explanation e = explain(scene, ray);
    EXPECT_TRUE(e.hits.empty() && e.crossings.empty());
    ASSERT_EQ(e.misses->size(), 6);
    for (const ExplainedMiss& miss : *e.misses) {
      EXPECT_TRUE(std::holds_alternative<std::monostate>(miss.primitive.numbers));
      EXPECT_EQ(miss.reason, "the ray is invalid or the shape is empty");
    }
    EXPECT_TRUE(nlohmann::json::accept(explanation_json(e)));
  }
}

TEST(Explain, LimitsHits) {
  std::vector<Shape> shapes(20, Sphere{});
  const PreparedScene scene(scene_of(shapes));
  const Explanation e = explain(scene, {.o = {0, 0, 5}}, {.max_hits = 3, .max_misses = 19});
  EXPECT_EQ(e.hits.size(), 3);
  EXPECT_EQ(e.hit_count, 20);
  EXPECT_EQ(e.visible, 0);
  EXPECT_FALSE(e.misses);
  const Explanation behind = explain(scene, {.o = {0, 0, -5}}, {.max_hits = 3});
  EXPECT_EQ(behind.crossings.size(), 3);
  EXPECT_EQ(behind.crossing_count, 20);
  EXPECT_EQ(behind.crossings[0].t, -4);
}

TEST(Explain, WritesNamesThatAreNotUtf8) {
  Scene scene = scene_of({Sphere{}});
  scene.objects[0].name = "\xff\"\n";
  const auto json =
      nlohmann::json::parse(explanation_json(explain(PreparedScene(scene), {.o = {0, 0, 5}})));
  EXPECT_EQ(json["hits"][0]["name"], "\xef\xbf\xbd\"\n");
}

}  // namespace
}  // namespace microtrace
