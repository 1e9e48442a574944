#include "scene/tone_map.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

struct Case {
  Vec3 light, khronos_pbr_neutral, aces, agx;
};

// Reference values computed with Python in float64 from the formulas of the Khronos specification
// and of three.js. The outset matrix of AgX is the inverse of the matrix printed in Filament.
constexpr Case kCases[] = {
    {{0.18, 0.18, 0.18},
     {0.14, 0.14, 0.14},
     {0.2131054, 0.2131054, 0.2131033},
     {0.2145486, 0.2145024, 0.2144992}},
    {{0.02, 0.02, 0.02},
     {0.0025, 0.0025, 0.0025},
     {0.007254808, 0.007254808, 0.007254735},
     {0.01823526, 0.0182295, 0.01823057}},
    {{0.5, 0.5, 0.5},
     {0.46, 0.46, 0.46},
     {0.5575863, 0.5575863, 0.5575808},
     {0.4251965, 0.4251201, 0.4251025}},
    {{1, 1, 1},
     {0.8690909, 0.8690909, 0.8690909},
     {0.7633974, 0.7633974, 0.7633898},
     {0.5902294, 0.5901361, 0.5901023}},
    {{4, 4, 4},
     {0.9832558, 0.9832558, 0.9832558},
     {0.9522369, 0.9522369, 0.9522273},
     {0.8610164, 0.8609102, 0.8608389}},
    {{100, 100, 100},
     {0.9994208, 0.9994208, 0.9994208},
     {1, 1, 1},
     {0.9969783, 0.9968787, 0.996779}},
    {{1, 0, 0},
     {0.88, 0.01555992, 0.01555992},
     {0.9573334, 0.005323721, 0.007157749},
     {0.7232757, 0.1058472, 0.06673564}},
    {{0, 1, 0},
     {0.01555992, 0.88, 0.01555992},
     {0.2933593, 0.7746073, 0.0994339},
     {0.2349969, 0.5845417, 0.1303556}},
    {{0, 0, 1},
     {0.01555992, 0.01555992, 0.88},
     {0, 0, 0.7728295},
     {0.03401252, 0.1354712, 0.7300098}},
    {{0.8, 0.4, 0.1},
     {0.76, 0.36, 0.06},
     {0.7348578, 0.4889884, 0.1586706},
     {0.5569931, 0.3686593, 0.1871537}},
    {{3, 0.5, 0.05},
     {0.9764477, 0.3424728, 0.2283573},
     {1, 0.639504, 0.200583},
     {0.9258726, 0.4892016, 0.2859582}},
    {{0.01, 0.02, 0.3},
     {0.000625, 0.010625, 0.290625},
     {0, 0.007326707, 0.3409034},
     {0.006715741, 0.05917825, 0.3665103}},
    {{20, 10, 30}, {0.9357106, 0.8733777, 0.9980435}, {1, 0.9925952, 1}, {1, 0.9741993, 1}},
    {{0.05, 0.7, 0.9},
     {0.01898542, 0.6417313, 0.8333454},
     {0.2435906, 0.6712806, 0.7288127},
     {0.2244928, 0.5181691, 0.5801711}},
};

void expect_near(const Vec3& is, const Vec3& wanted, const Vec3& light) {
  for (glm::length_t i = 0; i < 3; ++i)
    EXPECT_NEAR(is[i], wanted[i], 2e-6) << light.x << ' ' << light.y << ' ' << light.z;
}

TEST(ToneMap, AgreesWithReferenceValues) {
  for (const Case& c : kCases) {
    expect_near(tone_mapped(c.light, ToneMap::khronos_pbr_neutral), c.khronos_pbr_neutral, c.light);
    expect_near(tone_mapped(c.light, ToneMap::aces), c.aces, c.light);
    expect_near(tone_mapped(c.light, ToneMap::agx), c.agx, c.light);
    EXPECT_EQ(tone_mapped(c.light, ToneMap::none), c.light);
  }
}

TEST(ToneMap, GraysAreMonotonic) {
  for (const ToneMap map : kToneMaps) {
    EXPECT_EQ(tone_mapped(Vec3(0), map), Vec3(0)) << name_of(map);
    float before = -1;
    for (int i = -200; i <= 200; ++i) {
      const float light = std::exp2(static_cast<float>(i) * 0.1F);
      const float shown = tone_mapped(Vec3(light), map).y;
      EXPECT_TRUE(shown <= 1 || map == ToneMap::none) << name_of(map);
      EXPECT_GE(shown, before) << name_of(map) << ' ' << light;
      // Within six stops around middle gray, levels that 8 bits distinguish must stay distinct.
      if (light > 0.02F && light < 1.3F) {
        EXPECT_GT(shown, before + 2e-4F) << name_of(map);
      }
      before = shown;
    }
    EXPECT_GT(before, 0.99F) << name_of(map);
  }
}

TEST(ToneMap, HandlesAnyInput) {
  const float odd[] = {0, -1, 1e-40F, 1e-20F, 0.5F, 3e38F, HUGE_VALF, -HUGE_VALF, NAN};
  for (const ToneMap map : kToneMaps) {
    if (map == ToneMap::none) continue;
    for (const float r : odd) {
      for (const float g : odd) {
        for (const float b : odd) {
          const Vec3 shown = tone_mapped({r, g, b}, map);
          for (glm::length_t i = 0; i < 3; ++i) ASSERT_TRUE(shown[i] >= 0 && shown[i] <= 1);
        }
      }
    }
  }
}

TEST(ToneMap, NeutralKeepsColorsMinusReflection) {
  for (const Vec3 color : {Vec3(0.5F, 0.2F, 0.1F), Vec3(0.09F, 0.7F, 0.3F)}) {
    const Vec3 shown = tone_mapped(color, ToneMap::khronos_pbr_neutral);
    for (glm::length_t i = 0; i < 3; ++i) EXPECT_NEAR(shown[i], color[i] - 0.04F, 1e-7);
  }
}

TEST(ToneMap, HasNames) {
  for (const ToneMap map : kToneMaps) EXPECT_EQ(tone_map_named(name_of(map)), map);
  EXPECT_EQ(tone_map_named("filmic"), std::nullopt);
  EXPECT_EQ(name_of(ToneMap::khronos_pbr_neutral), "khronos-pbr-neutral");
}

}  // namespace
}  // namespace microtrace
