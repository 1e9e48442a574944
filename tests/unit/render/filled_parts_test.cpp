// Compares flat pictures whose parts of one color are filled with pictures of which each ray is
// traced.

#include "support/pictures.hpp"
#include "support/source_folder.hpp"

#include <microtrace/io.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Traces each ray as FlatIntegrator does, or asks first what the rays of a part have in common.
class CountingIntegrator final : public Integrator {
 public:
  explicit CountingIntegrator(bool asks) : asks_(asks) {}

  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    rays_ += rays.size();
    flat_.trace(world, rays, ids, samples);
  }
  [[nodiscard]] std::optional<Sample> common_sample(const World& world,
                                                    const Frustum& frustum) const override {
    if (!asks_) return std::nullopt;
    ++questions_;
    return flat_.common_sample(world, frustum);
  }
  [[nodiscard]] double rays() const { return static_cast<double>(rays_); }
  [[nodiscard]] double questions() const { return static_cast<double>(questions_); }

 private:
  FlatIntegrator flat_;
  bool asks_;
  mutable std::atomic<std::uint64_t> rays_{0}, questions_{0};
};

struct Fractions {
  double traced;  ///< of the rays
  double asked;   ///< number of questions, divided by the number of tiles of 8 x 8 pixels
};

/// Renders the scene in both ways and compares the pictures.
Fractions compare(const Scene& scene, ImageSize size, RenderOptions options) {
  const CountingIntegrator all(false), some(true);
  std::vector<Film> films;
  for (const CountingIntegrator* integrator : {&all, &some}) {
    options.integrator = integrator;
    films.push_back(render(scene, scene.cameras.at(0).camera, size, options));
  }
  EXPECT_TRUE(pixels_of(films[0]) == pixels_of(films[1]));
  const ImageSize part = films[0].size();
  for (std::uint32_t y = 0; films[0].has_alpha() && y < part.height; ++y)
    EXPECT_TRUE(std::ranges::equal(films[0].alpha_row(y), films[1].alpha_row(y)));
  EXPECT_TRUE(films[0].channels.empty() ||
              films[0].channels[0].values == films[1].channels[0].values);
  return {.traced = some.rays() / all.rays(),
          .asked = some.questions() * 64 / (double{1} * part.width * part.height)};
}

Scene example(const char* name) {
  return load_scene(tests::source_folder() / "scenes" / name).scene;
}

TEST(FilledParts, HaveTheColorsOfTracedRays) {
  for (const char* name : {"perspective1.json", "perspective2.json", "perspective3.json"}) {
    SCOPED_TRACE(name);
    const Scene scene = example(name);
    for (const unsigned threads : {1U, 2U, 5U}) {
      const Fractions fractions = compare(scene, {640, 480}, {.threads = threads});
      EXPECT_LT(fractions.traced, 0.15);
      EXPECT_LT(fractions.asked, 0.6) << "large parts should be filled at once";
    }
  }
}

TEST(FilledParts, AreSquaresOfTheWindow) {
  const Scene scene = example("perspective2.json");
  for (const PixelRect& crop :
       {PixelRect{.x0 = 3, .y0 = 5, .x1 = 296, .y1 = 238}, PixelRect{0, 0, 257, 225},
        PixelRect{.x0 = 100, .y0 = 99, .x1 = 101, .y1 = 200}}) {
    for (const std::uint32_t samples : {1U, 4U, 9U}) {
      compare(scene, {300, 240},
              {.threads = 1,
               .samples = samples,
               .crop = crop,
               .aovs = {Aov::depth},
               .transparent = samples == 4});
    }
  }
}

TEST(FilledParts, AreTilesIfThereAreFewForEachThread) {
  EXPECT_GT(compare(example("perspective1.json"), {320, 240}, {.threads = 16}).asked, 0.99);
}

}  // namespace
}  // namespace microtrace
