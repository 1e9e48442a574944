#include "render/lights/light_tree.hpp"

#include "support/shading/light_samples.hpp"

#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

struct Random {
  std::mt19937 bits{5};
  float operator()(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(bits);
  }
  Vec3 in_cube(float size) {
    return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)};
  }
  Vec3 direction() {
    const Vec3 v = in_cube(1);
    return v / std::sqrt(glm::dot(v, v));
  }
};

std::vector<LightBounds> lights(Random& random, int count) {
  std::vector<LightBounds> result;
  for (int i = 0; i < count; ++i) {
    const Vec3 p = random.in_cube(10), size = random.in_cube(0.5F);
    result.push_back(
        {.low = p - glm::abs(size),
         .high = p + glm::abs(size),
         .power = random(0.1F, 5),
         .cone = {.axis = random.direction(), .cos_o = i % 3 == 0 ? -1.0F : random(0.5F, 1)},
         .two_sided = i % 5 == 0});
  }
  return result;
}

LightNodes<1> small_light(float cos_o) {
  const float sin_o = std::sqrt(1 - cos_o * cos_o);
  return LightNodes<1>(
      LightNode{.center = {0, 0, 0},
                .radius = 1e-4F,
                .power = 1,
                .cos_o = cos_o,
                .cone = {.axis = {0, 0, 1}, .sin_o = sin_o, .cos_e = 0, .is_two_sided = 0}});
}

// Behind a light, the angle to its axis is near pi, whose sine is that of 0.
TEST(LightTree, LightsDontShineBehindThem) {
  for (const float x : {0.0F, 1e-4F, 3e-4F, 1e-3F, 0.1F, 1.0F}) {
    for (const float cos_o : {1.0F, 0.9F}) {
      EXPECT_EQ(small_light(cos_o).importance({x, 0, -3}, {0, 0, 1}), 0) << x;
      EXPECT_GT(small_light(cos_o).importance({x, 0, 3}, {0, 0, 1}), 0.05F) << x;
    }
    EXPECT_GT(small_light(-0.9F).importance({x, 0, -3}, {0, 0, 1}), 0) << x;
    EXPECT_EQ(small_light(-1).importance({x, 0, 3}, {0, 0, 1}),
              small_light(-1).importance({x, 0, -3}, {0, 0, 1}));
  }
}

// The sum may be below 1, because a node may have bounds that contribute although neither of its
// children does.
TEST(LightTree, ProbabilitiesAddUpToOne) {
  Random random;
  for (const int count : {1, 2, 3, 17, 300}) {
    const LightTree tree(lights(random, count));
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = random.in_cube(15), n = random.direction();
      double sum = 0, chosen = 0;
      for (int light = 0; light < count; ++light) sum += tree.probability(std::size_t(light), p, n);
      for (int k = 0; k < 1000; ++k)
        chosen += chosen_light(tree, p, n, (float(k) + 0.5F) / 1000) ? 1e-3 : 0;
      EXPECT_LE(sum, 1 + 1e-4) << count;
      EXPECT_NEAR(sum, chosen, 0.01) << count;
    }
  }
}

TEST(LightTree, ChoosesEachByItsProbability) {
  Random random;
  constexpr int count = 40, samples = 100000;
  const LightTree tree(lights(random, count));
  for (int i = 0; i < 5; ++i) {
    const Vec3 p = random.in_cube(5), n = random.direction();
    std::vector<int> chosen(count);
    for (int k = 0; k < samples; ++k) {
      const auto choice = chosen_light(tree, p, n, (float(k) + 0.5F) / samples);
      ASSERT_TRUE(choice);
      EXPECT_EQ(choice->probability, tree.probability(choice->light, p, n));
      ++chosen[choice->light];
    }
    for (std::size_t light = 0; light < count; ++light)
      EXPECT_NEAR(chosen[light], tree.probability(light, p, n) * samples, 2 + 1e-4 * samples);
  }
}

// The bounds of a tree must contribute wherever the bounds of one of its lights do. No contributing
// light is then omitted.
TEST(LightTree, UnitedBoundsContainBoth) {
  Random random;
  for (int i = 0; i < 20000; ++i) {
    const auto two = lights(random, 2);
    const Vec3 p = random.in_cube(12), n = random.direction();
    const LightTree tree(two);
    const auto importance = [&](std::uint32_t node) {
      return LightNodes<1>(tree.nodes()[node]).importance(in_tree_units<1>(tree.space(), p), n);
    };
    const std::uint32_t children = tree.nodes()->children;
    if (importance(children) > 0 || importance(children + 1) > 0) {
      EXPECT_GT(importance(0), 0);
    }
  }
}

// Compares a floor under many lights with the sum over single lights.
TEST(LightTree, ManyLightsOverAFloor) {
  Scene scene;
  scene.materials = {{.base_color = {0.5F, 0.5F, 0.5F, 1}, .metallic = 1, .roughness = 1}};
  scene.objects.push_back({.name = "floor", .shape = Plane{{0, 0, 0}, {0, 1, 0}}, .material = 0});
  scene.environment = Environment{.content = Vec3(0)};
  Random random;
  const OrthographicCamera camera{
      .pose = {.position = {0, 1, 0}, .direction = {0, -1, 0}, .up = {0, 0, -1}}, .height = 0.01};
  const PathIntegrator path;
  const auto brightness = [&](std::uint32_t samples) {
    Film film =
        render(scene, camera, {.width = 1, .height = 1}, {.integrator = &path, .samples = samples});
    return double{film.at(0, 0).x};
  };
  double sum = 0;
  std::vector<NamedLight> all;
  for (int i = 0; i < 300; ++i) {
    const Vec3 place(random(-30, 30), random(0.5F, 3), random(-30, 30));
    scene.lights = {
        {.name = "lamp", .light = PointLight{.position = DVec3(place), .intensity = random(1, 9)}}};
    all.push_back(scene.lights[0]);
    sum += brightness(1);
  }
  scene.lights = all;
  EXPECT_NEAR(brightness(16384), sum, 0.01 * sum);
  // Few samples must suffice too. With 256 samples, selecting lights by power alone would have an
  // error of about one half.
  EXPECT_NEAR(brightness(256), sum, 0.1 * sum);
}

}  // namespace
}  // namespace microtrace
