#include "render/guiding/guide_distribution.hpp"
#include "render/kernels/finish_guided.hpp"
#include "render/lanes/dispatch.hpp"

#include <array>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

class GuideKernels : public testing::TestWithParam<const ShadingKernels*> {
 protected:
  /// A distribution of which some bins are divided.
  GuideDistribution distribution(const SignedAxis& about) {
    std::vector<ArrivingLight> light;
    const HemisphereBins bins(about);
    for (int i = 0; i < 3000; ++i) {
      const int bin = i % 3 == 0 ? i / 3 % HemisphereBins::kCount : i % 3 == 1 ? 50 : 51;
      light.push_back({.d = bins.direction(bin, {u(), u() * u()}), .amount = 1000});
    }
    return distribution_of(about, light);
  }
  float u() { return std::uniform_real_distribution<float>(0, 0x0.ffffffp0F)(random_); }

  const ShadingKernels& kernels_ = *GetParam();
  std::mt19937 random_{5};
};

TEST_P(GuideKernels, SampleLikeSingleDirections) {
  std::vector<GuideDistribution> distributions;
  for (int i = 0; i < 6; ++i)
    distributions.push_back(distribution({.axis = i / 2, .is_down = i % 2 != 0}));
  GuideLanes<kShadingLanes> lanes{};
  for (int round = 0; round < 500; ++round) {
    std::array<const GuideDistribution*, kShadingLanes> of_lane{};
    for (std::size_t i = 0; i < kShadingLanes; ++i) {
      of_lane[i] = &distributions[random_() % distributions.size()];
      lanes.tables[i] = &of_lane[i]->table();
      lanes.u[0][i] = u();
      lanes.u[1][i] = u();
    }
    kernels_.sample_guides(lanes);
    for (std::size_t i = 0; i < kShadingLanes; ++i) {
      const Vec3 d = of_lane[i]->sample({lanes.u[0][i], lanes.u[1][i]});
      for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(lanes.wi[axis][i], d[axis]);
      // Half of the directions are below the hemisphere.
      if (random_() % 2 == 0) {
        for (auto& component : lanes.wi) component[i] = -component[i];
      }
    }
    kernels_.guide_pdfs(lanes);
    for (std::size_t i = 0; i < kShadingLanes; ++i) {
      const Vec3 d(lanes.wi[0][i], lanes.wi[1][i], lanes.wi[2][i]);
      EXPECT_EQ(lanes.pdf[i], of_lane[i]->pdf(d));
      EXPECT_EQ(lanes.pdf[i] > 0,
                glm::dot(d, of_lane[i]->sample({lanes.u[0][i], lanes.u[1][i]})) > 0);
    }
  }
}

TEST_P(GuideKernels, FinishMixturesLikeSingleLanes) {
  for (const float most_survival : {1.0F, 0.95F}) {
    for (int round = 0; round < 200; ++round) {
      ScatterLanes lanes{};
      for (int i = 0; i < kShadingLanes; ++i) {
        lanes.pdf[i] = random_() % 8 == 0 ? 0 : u();
        lanes.guide_part[i] = random_() % 4 == 0 ? 0 : 0.5F;
        lanes.guide_pdf[i] = u();
        lanes.brightness[i] = lanes.guide_part[i] == 0 ? -1 : u();
        lanes.is_smooth[i] = random_() % 8 == 0 ? 1 : 0;
        lanes.chances[1][i] = u();
        for (auto& component : lanes.next_throughput) component[i] = u();
      }
      ScatterLanes single = lanes;
      kernels_.finish_guided(most_survival, lanes);
      for (int i = 0; i < kShadingLanes; ++i) finish_guided_from<1>(most_survival, single, i);
      for (int i = 0; i < kShadingLanes; ++i) {
        EXPECT_EQ(lanes.pdf[i], single.pdf[i]);
        if (lanes.pdf[i] == 0) continue;  // the throughput is unused
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_EQ(lanes.next_throughput[axis][i], single.next_throughput[axis][i]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, GuideKernels, testing::ValuesIn(kShadingKernels.available()),
                         [](const auto& test) { return std::string(test.param->name); });

}  // namespace
}  // namespace microtrace
