// Compares the light sampling kernels of every instruction set of this machine bit by bit with the
// one-lane instance.
#include "render/kernels/sample_triangles.hpp"
#include "render/lanes/dispatch.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/lights/choose_lights.hpp"
#include "render/lights/light_tree.hpp"
#include "render/lights/punctual.hpp"
#include "support/lane_tests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

class LightKernelsTest : public testing::TestWithParam<const ShadingKernels*> {};

std::vector<LightBounds> any_lights(LaneRandom& random, int count) {
  std::vector<LightBounds> result;
  for (int i = 0; i < count; ++i) {
    const Vec3 p = 10.0F * random.vector(), size = random.color();
    result.push_back(
        {.low = p,
         .high = random.number() < 0.2F ? p : p + size,
         .power = random.number() * std::exp2(40 * double{random.signed_unit()}) + 1e-30,
         .cone = {.axis = random.direction(),
                  .cos_o = random.number() < 0.3F ? -1 : random.number()},
         .two_sided = random.number() < 0.3F});
  }
  return result;
}

TEST_P(LightKernelsTest, LightsAreChosenWithTheBitsOfOneLane) {
  LaneRandom random(4);
  std::array<int, 4> kinds{};
  for (int round = 0; round < kRounds; ++round) {
    const LightTree tree(any_lights(random, 1 + static_cast<int>(random.bits() % 50)));
    const LightChoiceSetup setup{
        .nodes = random.number() < 0.2F ? nullptr : tree.nodes(),
        .space = tree.space(),
        .has_far = random.number() < 0.5F,
        .environment_light = random.number() < 0.5F ? 0 : std::exp2(20 * random.signed_unit()),
        .far_light = random.number()};
    LightChoices<kShadingLanes> lanes{};
    for (int i = 0; i < kShadingLanes; ++i) {
      put(lanes.p, i, 12.0F * random.vector());
      put(lanes.n, i, random.direction());
      lanes.share[i] = random.number();
      lanes.choice[i] = random.number();
    }
    LightChoices<kShadingLanes> expected = lanes;
    GetParam()->choose_lights(setup, lanes);
    choose_lights<1>(setup, expected);
    for (int i = 0; i < kShadingLanes; ++i) {
      ++kinds[static_cast<std::size_t>(lanes.kind[i])];
      ASSERT_EQ(lanes.kind[i], expected.kind[i]);
      if (lanes.kind[i] == LightKind::none) continue;
      ASSERT_EQ(lanes.probability[i], expected.probability[i]);
      expect_bits(lanes.choice[i], expected.choice[i], "choice");
      if (lanes.kind[i] == LightKind::near) {
        ASSERT_EQ(lanes.light[i], expected.light[i]);
      }
    }
  }
  for (const int count : kinds) EXPECT_GT(count, kRounds / 10);
}

TEST_P(LightKernelsTest, TrianglesAreSampledWithTheBitsOfOneLane) {
  LaneRandom random(5);
  int lit = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::array<TriangleLight, kShadingLanes> triangles{};
    TriangleChoices<kShadingLanes> choices{};
    LightChoices<kShadingLanes> points{};
    LightSamples<kShadingLanes> lanes{};
    for (int i = 0; i < kShadingLanes; ++i) {
      const float size = std::exp2(60 * random.signed_unit());
      put(points.p, i, size * random.vector());
      TriangleLight& light = triangles[static_cast<std::size_t>(i)];
      const auto set = [](float(&to)[3], const Vec3& v) {
        for (int axis = 0; axis < 3; ++axis) to[axis] = v[axis];
      };
      for (auto& corner : light.corners) set(corner, size * random.vector());
      const Vec3 emission = random.number() < 0.1F ? Vec3(0) : random.color();
      light.id = 100 + static_cast<std::uint32_t>(i);
      light.has_back = random.number() < 0.5F ? 0.0F : 1.0F;
      light.is_textured = random.bits() % 2;
      if (light.is_textured != 0)
        put(choices.emission, i, emission);
      else
        set(light.emission, emission);
      choices.coverage[i] = random.number() < 0.1F ? 0 : random.number();
      for (auto& u : choices.u) u[i] = random.number();
      choices.triangle[i] = static_cast<std::uint32_t>(i) ^ (random.bits() & 1U);
      choices.selected[i] = random.number() < 0.2F ? 0.0F : 1.0F;
      points.probability[i] = random.number() + 1e-6F;
      lanes.pdf[i] = -1;
      lanes.target[i] = 7;
    }
    LightSamples<kShadingLanes> expected = lanes;
    GetParam()->sample_triangles(triangles.data(), choices, points, lanes);
    sample_triangles<1>(triangles.data(), choices, points, expected);
    for (int i = 0; i < kShadingLanes; ++i) {
      expect_bits(lanes.pdf[i], expected.pdf[i], "pdf");
      ASSERT_EQ(lanes.target[i], expected.target[i]);
      ASSERT_EQ(lanes.target[i], lanes.pdf[i] == -1 ? 7 : 100 + choices.triangle[i]);
      expect_bits(lanes.is_far[i], expected.is_far[i], "is_far");
      expect_bits(lanes.to_light, expected.to_light, i, "to_light");
      expect_bits(lanes.wi, expected.wi, i, "wi");
      expect_bits(lanes.light, expected.light, i, "light");
      if (choices.selected[i] == 0) {
        ASSERT_EQ(lanes.pdf[i], -1);
      }
      lit += lanes.pdf[i] > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(lit, kRounds * kShadingLanes / 4);
}

std::vector<PunctualLight> any_punctual_lights(LaneRandom& random) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<PunctualLight> result;
  for (int i = 0; i < 30; ++i) {
    const DVec3 place(10.0F * random.vector()), axis = glm::normalize(DVec3(random.direction()));
    const Vec3 color = random.color();
    const float intensity = std::exp2(60 * random.signed_unit());
    const double range = random.number() < 0.3F ? kInfinity : 20 * double{random.number()} + 1e-3;
    const double outer = 0.1 + double{random.number()};
    const std::array<Light, 3> kinds = {
        DirectionalLight{.direction = axis, .color = color, .intensity = intensity},
        PointLight{.position = place, .color = color, .intensity = intensity, .range = range},
        SpotLight{.position = place,
                  .direction = axis,
                  .color = color,
                  .intensity = intensity,
                  .range = range,
                  .inner_angle = outer * double{random.number()},
                  .outer_angle = outer}};
    result.push_back(punctual_light(kinds[random.bits() % kinds.size()]));
  }
  return result;
}

TEST_P(LightKernelsTest, PunctualLightsAreSampledWithTheBitsOfOneLight) {
  LaneRandom random(9);
  int lit = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<PunctualLight> lights = any_punctual_lights(random);
    PunctualChoices<kShadingLanes> choices{};
    LightChoices<kShadingLanes> points{};
    LightSamples<kShadingLanes> lanes{};
    for (int i = 0; i < kShadingLanes; ++i) {
      choices.light[i] = random.bits() % static_cast<std::uint32_t>(lights.size());
      choices.selected[i] = random.number() < 0.2F ? 0.0F : 1.0F;
      choices.group_size[i] = static_cast<float>(1 + random.bits() % 3);
      put(points.p, i, 12.0F * random.vector());
      if (random.number() < 0.05F) {
        const double(&place)[3] = lights[choices.light[i]].position;
        put(points.p, i, Vec3(DVec3(place[0], place[1], place[2])));
      }
      points.probability[i] = random.number() + 1e-6F;
      lanes.pdf[i] = -1;
    }
    GetParam()->sample_punctual(lights.data(), choices, points, lanes);
    for (int i = 0; i < kShadingLanes; ++i) {
      const auto found = of_punctual(lights[choices.light[i]], got(points.p, i));
      if (choices.selected[i] == 0 || !found) {
        ASSERT_EQ(lanes.pdf[i], -1);
        continue;
      }
      ++lit;
      const LightSample one =
          found->with_probability(double{points.probability[i]} / double{choices.group_size[i]});
      ASSERT_EQ(lanes.pdf[i], 0);
      ASSERT_EQ(lanes.is_far[i] != 0, one.is_far);
      ASSERT_EQ(got(lanes.to_light, i), one.to_light);
      ASSERT_EQ(got(lanes.wi, i), one.wi);
      ASSERT_EQ(got(lanes.light, i), one.light);
    }
  }
  EXPECT_GT(lit, kRounds * kShadingLanes / 4);
}

// The falloff of KHR_lights_punctual, computed here in its own way.
TEST(PunctualLights, FallOffAsSpecified) {
  const SpotLight spot{.position = {1, 2, 3},
                       .direction = {0, -1, 0},
                       .color = Vec3(1, 0.5F, 0.25F),
                       .intensity = 8,
                       .range = 4,
                       .inner_angle = 0.2,
                       .outer_angle = 0.7};
  for (const double angle : {0.0, 0.1, 0.3, 0.5, 0.69, 0.75}) {
    const double reach = 2.5;
    const Vec3 p(DVec3(1 + reach * std::sin(angle), 2 - reach * std::cos(angle), 3));
    const double range_part = std::max(0.0, 1 - std::pow(reach / 4, 4));
    const double scale = 1 / (std::cos(0.2) - std::cos(0.7));
    const double cone_part = std::clamp((std::cos(angle) - std::cos(0.7)) * scale, 0.0, 1.0);
    const double expected = 8 * range_part * cone_part * cone_part / (reach * reach);
    const auto found = of_punctual(punctual_light(spot), p);
    ASSERT_EQ(found.has_value(), expected > 0) << angle;
    if (!found) continue;
    EXPECT_NEAR(found->light.x, expected, 1e-5 * expected) << angle;
    EXPECT_NEAR(found->light.z, expected / 4, 1e-5 * expected) << angle;
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, LightKernelsTest, testing::ValuesIn(kShadingKernels.available()),
                         [](const auto& set) { return std::string(set.param->name); });

}  // namespace
}  // namespace microtrace
