// Checks that axis-aligned walls that touch and share planes cost no more than other walls. Counts
// the queries that reach exact arithmetic in path-traced pictures.

#include "support/cases/architecture.hpp"

#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <cctype>
#include <cstddef>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

struct Asked {
  StageCounts stages;
  std::uint64_t questions;
};

Asked draw(const generated::ArchitectureScene& architecture, const Pose& view, unsigned threads) {
  const PathIntegrator integrator;
  RenderCounts counts;
  static_cast<void>(
      render(generated::as_scene(architecture), PerspectiveCamera{.pose = view}, {64, 48},
             {.threads = threads, .integrator = &integrator, .samples = 8, .counts = &counts}));
  return {.stages = counts.stages,
          .questions = counts.rays.camera.rays + counts.rays.path.rays + counts.rays.shadow.rays +
                       counts.stages.origins};
}

class ArchitectureCost : public testing::TestWithParam<std::string> {};

TEST_P(ArchitectureCost, FewQueriesNeedExactArithmetic) {
  const auto scene = generated::architecture(GetParam());
  const auto turned = generated::turned(generated::architecture(GetParam()));
  for (const auto* architecture : {&scene, &turned}) {
    for (std::size_t view = 0; view < architecture->views.size(); ++view) {
      SCOPED_TRACE((architecture == &scene ? "aligned, view " : "turned, view ") +
                   std::to_string(view));
      const auto [stages, questions] = draw(*architecture, architecture->views[view], 2);
      ASSERT_GT(questions, 10'000U);
      EXPECT_GT(stages.origins, 0U);
      EXPECT_LE(stages.dyadic * 10'000, questions);
      // In the axis-aligned view, pixel centers lie exactly on edges, so more queries need exact
      // arithmetic.
      const std::uint64_t most = view == 0 ? 1'000 : 30;
      EXPECT_LE(stages.grid * most, questions);
      EXPECT_LE(stages.searched_origins * most, stages.origins);
      EXPECT_LE(stages.missing_origins * 10'000, stages.origins);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ArchitectureCost,
                         testing::ValuesIn(generated::architecture_names()), [](const auto& name) {
                           std::string word = name.param;
                           for (char& c : word) c = std::isalnum(c) != 0 ? c : '_';
                           return word;
                         });

// Scenes with few triangles had no tree, so the filters tested each triangle for each ray.
TEST(StageCounts, RaysInSmallScenesRarelyReachTheFilters) {
  auto scene = generated::turned(generated::architecture("room"));
  for (const std::size_t triangles : {1, 4, 12, 14, 15, 30}) {
    SCOPED_TRACE(triangles);
    auto small = scene;
    small.mesh.triangles.resize(triangles);
    const auto [stages, questions] = draw(small, small.views[0], 1);
    ASSERT_GT(questions, 3'000U);  // tiles without hits have none
    EXPECT_LE(stages.filters * 5, questions);
  }
}

TEST(StageCounts, DoNotDependOnThreads) {
  const auto scene = generated::architecture("skewed room");
  const auto one = draw(scene, scene.views[1], 1).stages,
             seven = draw(scene, scene.views[1], 7).stages;
  EXPECT_GT(one.edges, 0U);
  EXPECT_GT(one.filters, 0U);
  EXPECT_EQ(one.edges, seven.edges);
  EXPECT_EQ(one.filters, seven.filters);
  EXPECT_EQ(one.grid, seven.grid);
  EXPECT_EQ(one.dyadic, seven.dyadic);
  EXPECT_EQ(one.origins, seven.origins);
  EXPECT_EQ(one.searched_origins, seven.searched_origins);
}

}  // namespace
}  // namespace microtrace
