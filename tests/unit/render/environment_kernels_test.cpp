// Compares the kernels that sample environments, of every instruction set of this machine, bit by
// bit with the one-lane instance.
#include "render/guiding/guide_distribution.hpp"
#include "render/guiding/guide_table.hpp"
#include "render/guiding/sky_grid.hpp"
#include "render/kernels/sample_environment.hpp"
#include "render/lanes/dispatch.hpp"
#include "render/lanes/lane_access.hpp"
#include "support/lane_tests.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

class EnvironmentKernels : public testing::TestWithParam<const ShadingKernels*> {
 protected:
  EnvironmentKernels() {
    for (int face = 0; face < 6; ++face) {
      const SignedAxis about = SignedAxis::of_face(static_cast<std::size_t>(face));
      std::vector<GuideDistribution::Weight> weights;
      for (int bin = face; bin < HemisphereBins::kCount; bin += 7) {
        weights.push_back(
            {.bin = bin, .part = GuideTable::kWhole, .weight = double{random_.number()}});
      }
      guides_.emplace_back(about, weights);
    }
  }

  void set(EnvironmentCells<kShadingLanes>& cells) {
    cells.is_uniform = random_.number() < 0.5F;
    cells.is_any = random_.number() < 0.9F;
    for (int i = 0; i < kShadingLanes; ++i) {
      cells.guides.tables[i] = &guides_[random_.bits() % guides_.size()].table();
      cells.part[i] = cells.is_any && random_.number() < 0.7F ? 0.875F * random_.number() : 0;
      put(cells.guides.wi, i, random_.direction());
    }
  }
  void set(LightChoices<kShadingLanes>& choices) {
    for (int i = 0; i < kShadingLanes; ++i) {
      choices.kind[i] = random_.number() < 0.7F ? LightKind::environment
                                                : static_cast<LightKind>(random_.bits() % 4);
      choices.probability[i] = random_.number() + 0x1p-10F;
      choices.choice[i] = choices.probability[i] * random_.number();
    }
  }
  void set(MapLanes<kShadingLanes>& lanes) {
    for (int i = 0; i < kShadingLanes; ++i) {
      put(lanes.d, i, random_.direction());
      put(lanes.radiance, i, random_.color());
      lanes.pdf[i] = random_.number() + 0x1p-10F;
    }
  }

  const ShadingKernels& kernels_ = *GetParam();
  LaneRandom random_{3};
  std::vector<GuideDistribution> guides_;
};

TEST_P(EnvironmentKernels, FindTheCellsOfSurfaces) {
  for (int round = 0; round < kRounds; ++round) {
    SkyGrid grid{};
    grid.cell_size = double{random_.number()} + 0.1;
    for (int axis = 0; axis < 3; ++axis) {
      grid.low[axis] = double{random_.signed_unit()};
      grid.size[axis] = static_cast<std::int32_t>(1 + random_.bits() % 16);
    }
    LaneFloats p[3], n[3];
    for (int i = 0; i < kShadingLanes; ++i) {
      put(p, i, 10.0F * random_.vector());
      // Many normals are along axes, or equally near to two of them.
      const Vec3 whole(glm::round(random_.vector()));
      put(n, i, random_.bits() % 2 == 0 ? random_.direction() : whole);
    }
    std::uint32_t cells[kShadingLanes];
    kernels_.find_sky_cells(grid, p, n, cells);
    for (int i = 0; i < kShadingLanes; ++i) {
      const Vec3 at = got(p, i), normal = got(n, i);
      std::uint32_t expected = 0;
      for (std::uint32_t axis : {2U, 1U, 0U}) {
        const float size = std::abs(normal[static_cast<int>(axis)]);
        if (size >= std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)}))
          expected = 2 * axis + (normal[static_cast<int>(axis)] < 0 ? 1 : 0);
      }
      for (int axis = 0; axis < 3; ++axis) {
        const double cell = std::floor((double{at[axis]} - grid.low[axis]) / grid.cell_size);
        const auto size = static_cast<std::uint32_t>(grid.size[axis]);
        expected = expected * size +
                   static_cast<std::uint32_t>(std::clamp(cell, 0.0, double{1} * (size - 1)));
      }
      ASSERT_EQ(cells[i], expected);
    }
  }
}

TEST_P(EnvironmentKernels, SampleWithTheBitsOfOneLane) {
  std::array<int, 2> counts{};
  for (int round = 0; round < kRounds; ++round) {
    LightChoices<kShadingLanes> choices{};
    EnvironmentSamples<kShadingLanes> from{};
    set(choices);
    set(from.cells);
    set(from.independent);
    set(from.visible);
    LightSamples<kShadingLanes> samples{};
    std::ranges::fill(samples.pdf, -1.0F);
    LightSamples<kShadingLanes> expected = samples;
    EnvironmentSamples<kShadingLanes> single = from;
    const int count = 1 + round % kShadingLanes;
    kernels_.split_environment(choices, count, from);
    split_environment<1>(choices, count, single);
    ASSERT_EQ(from.lanes_independent, single.lanes_independent);
    ASSERT_EQ(from.lanes_by_visibility, single.lanes_by_visibility);
    const Lanes lanes = from.lanes_independent | from.lanes_by_visibility;
    ASSERT_EQ(lanes >> count, 0U);
    counts[0] += std::popcount(from.lanes_independent);
    counts[1] += std::popcount(from.lanes_by_visibility);
    kernels_.finish_environment(choices, from, samples);
    finish_environment<1>(choices, single, expected);
    for (int i = 0; i < count; ++i) {
      const bool is_selected = choices.kind[i] == LightKind::environment &&
                               (!from.cells.is_uniform || from.cells.part[i] > 0);
      ASSERT_EQ((lanes >> i & 1U) != 0, is_selected);
      ASSERT_EQ(samples.pdf[i] != -1, is_selected);
      expect_bits(samples.pdf[i], expected.pdf[i], "pdf");
      expect_bits(samples.is_far[i], expected.is_far[i], "is_far");
      expect_bits(samples.wi, expected.wi, i, "wi");
      expect_bits(samples.to_light, expected.to_light, i, "to_light");
      expect_bits(samples.light, expected.light, i, "light");
    }
  }
  for (const int number : counts) EXPECT_GT(number, kRounds);
}

TEST_P(EnvironmentKernels, MixPdfsWithTheBitsOfOneLane) {
  for (int round = 0; round < kRounds; ++round) {
    EnvironmentCells<kShadingLanes> cells{};
    MapLanes<kShadingLanes> lanes{};
    set(cells);
    set(lanes);
    EnvironmentCells<kShadingLanes> single = cells;
    LaneFloats expected;
    copy(expected, lanes.pdf);
    kernels_.mix_environment_pdfs(lanes.d, cells, lanes.pdf);
    mix_environment_pdfs<1>(lanes.d, single, expected);
    for (int i = 0; i < kShadingLanes; ++i) expect_bits(lanes.pdf[i], expected[i], "pdf");
  }
}

TEST_P(EnvironmentKernels, SampleUniformDirectionsWithTheBitsOfOneLane) {
  for (int round = 0; round < kRounds; ++round) {
    LaneFloats u[2], d[3], expected[3];
    for (auto& numbers : u) {
      for (float& number : numbers) number = random_.number();
    }
    kernels_.sample_sphere(u, d);
    sample_sphere<1>(u, expected);
    for (int i = 0; i < kShadingLanes; ++i) expect_bits(d, expected, i, "d");
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, EnvironmentKernels, testing::ValuesIn(kShadingKernels.available()),
                         [](const auto& test) { return std::string(test.param->name); });

}  // namespace
}  // namespace microtrace
