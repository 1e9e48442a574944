#include <microtrace/error.hpp>
#include <microtrace/render.hpp>
#include <microtrace/sampled_aov.hpp>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// Returns 0 for samples with even numbers and 2 for odd ones.
class AlternatingIntegrator final : public Integrator {
 public:
  void trace(const World& /*world*/, std::span<const Ray> /*rays*/, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    for (std::size_t i = 0; i < ids.size(); ++i)
      samples[i] = {.color = Vec3(ids[i].index % 2 == 0 ? 0.0F : 2.0F), .alpha = 1};
  }
  [[nodiscard]] bool is_random() const override { return true; }
};

constexpr ImageSize kSize{.width = 20, .height = 20};

/// Renders the half plane x < 0.33 with an orthographic camera that shows [-1, 1] x [-1, 1]. The
/// half plane covers 0.3 of each pixel in column 13.
Film drawn(RenderOptions options) {
  Scene scene;
  scene.background = Vec3(1);
  scene.materials = {{.base_color = Vec4(0.5F, 1, 0.25F, 1)}};
  scene.objects.push_back({.name = "left",
                           .shape = Triangle{{0.33F, -100, 0}, {0.33F, 100, 0}, {-200, 0, 0}},
                           .material = 0});
  static const AlternatingIntegrator integrator;
  if (options.integrator == nullptr) options.integrator = &integrator;
  return render(scene, OrthographicCamera{.pose = {.position = {0, 0, 1}}}, kSize, options);
}

float value(const Film& film, std::size_t channel, std::uint32_t x, std::uint32_t y) {
  return std::get<std::vector<float>>(film.channels.at(channel).values)[y * kSize.width + x];
}

TEST(SampledAov, VarianceAndNumberOfSamples) {
  const std::vector<SampledAov> wanted = {SampledAov::variance, SampledAov::samples};
  const Film film = drawn({.samples = 10, .sampled_aovs = wanted});
  ASSERT_EQ(film.channels.size(), 2U);
  EXPECT_EQ(film.channels[0].name, "variance.Y");
  EXPECT_EQ(film.channels[1].name, "samples.N");
  EXPECT_NEAR(value(film, 0, 7, 3), 1.0 / 9, 1e-6);  // (mean of squares - square of mean) / (n - 1)
  EXPECT_EQ(value(film, 1, 19, 19), 10);
  const Film by_passes = drawn({.samples = 10, .passes = Passes{}, .sampled_aovs = wanted});
  EXPECT_EQ(value(by_passes, 0, 7, 3), value(film, 0, 7, 3));
}

TEST(SampledAov, FeaturesAreFilteredLikeColors) {
  const Film film =
      drawn({.samples = 64,
             .aovs = {Aov::depth},
             .sampled_aovs = {SampledAov::denoise_normal, SampledAov::denoise_albedo}});
  ASSERT_EQ(film.channels.size(), 7U);
  EXPECT_EQ(film.channels[0].name, "depth.Z");
  EXPECT_EQ(film.channels[1].name, "denoise_normal.X");
  EXPECT_EQ(film.channels[6].name, "denoise_albedo.B");
  EXPECT_EQ(value(film, 3, 12, 5), 1);
  EXPECT_EQ(value(film, 4, 12, 5), 0.5F);
  EXPECT_EQ(value(film, 6, 12, 5), 0.25F);
  const float share = value(film, 3, 13, 5);
  EXPECT_NEAR(share, 0.3, 1.0 / 16);
  EXPECT_EQ(value(film, 4, 13, 5), 0.5F * share);
  EXPECT_EQ(value(film, 5, 13, 5), share);
  for (std::size_t channel = 1; channel < 7; ++channel) EXPECT_EQ(value(film, channel, 14, 5), 0);
}

TEST(SampledAov, NamesAreThoseOfTheCommandLine) {
  for (const SampledAov aov : kSampledAovs) EXPECT_EQ(sampled_aov_named(name_of(aov)), aov);
  EXPECT_EQ(sampled_aov_named("depth"), std::nullopt);
}

TEST(SampledAov, NeedARandomIntegratorAndNoDuplicates) {
  const FlatIntegrator flat;
  EXPECT_THROW((void)drawn({.integrator = &flat, .sampled_aovs = {SampledAov::samples}}), Error);
  EXPECT_THROW((void)drawn({.sampled_aovs = {SampledAov::samples, SampledAov::samples}}), Error);
}

}  // namespace
}  // namespace microtrace
