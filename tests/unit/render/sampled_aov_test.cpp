#include <microtrace/error.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>
#include <microtrace/sampled_aov.hpp>

#include <cmath>
#include <numeric>
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

constexpr ImageSize kSampledSize{.width = 20, .height = 20};

/// Renders the half plane x < 0.33 with an orthographic camera that shows [-1, 1] x [-1, 1]. The
/// half plane covers 0.3 of each pixel in column 13.
Film drawn_samples(RenderOptions options) {
  Scene scene;
  scene.background = Vec3(1);
  scene.materials = {{.base_color = Vec4(0.5F, 1, 0.25F, 1)}};
  scene.objects.push_back({.name = "left",
                           .shape = Triangle{{0.33F, -100, 0}, {0.33F, 100, 0}, {-200, 0, 0}},
                           .material = 0});
  static const AlternatingIntegrator integrator;
  if (options.integrator == nullptr) options.integrator = &integrator;
  return render(scene, OrthographicCamera{.pose = {.position = {0, 0, 1}}}, kSampledSize, options);
}

float value(const Film& film, std::size_t channel, std::uint32_t x, std::uint32_t y) {
  return std::get<std::vector<float>>(film.channels.at(channel).values)[y * kSampledSize.width + x];
}

TEST(SampledAov, VarianceAndNumberOfSamples) {
  const std::vector<SampledAov> wanted = {SampledAov::variance, SampledAov::samples};
  const Film film = drawn_samples({.samples = 10, .sampled_aovs = wanted});
  ASSERT_EQ(film.channels.size(), 2U);
  EXPECT_EQ(film.channels[0].name, "variance.Y");
  EXPECT_EQ(film.channels[1].name, "samples.N");
  EXPECT_NEAR(value(film, 0, 7, 3), 1.0 / 9, 1e-6);  // (mean of squares - square of mean) / (n - 1)
  EXPECT_EQ(value(film, 1, 19, 19), 10);
  const Film by_passes = drawn_samples({.samples = 10, .passes = Passes{}, .sampled_aovs = wanted});
  EXPECT_EQ(value(by_passes, 0, 7, 3), value(film, 0, 7, 3));
}

/// The albedo of a dielectric: the share that its surface reflects is white.
float albedo_of(float base) {
  return base + 0.04F * (1 - base);
}

TEST(SampledAov, FeaturesAreFilteredLikeColors) {
  const Film film =
      drawn_samples({.samples = 4,
                     .aovs = {Aov::depth},
                     .sampled_aovs = {SampledAov::denoise_normal, SampledAov::denoise_albedo}});
  ASSERT_EQ(film.channels.size(), 7U);
  EXPECT_EQ(film.channels[0].name, "depth.Z");
  EXPECT_EQ(film.channels[1].name, "denoise_normal.X");
  EXPECT_EQ(film.channels[6].name, "denoise_albedo.B");
  EXPECT_EQ(value(film, 3, 12, 5), 1);
  EXPECT_FLOAT_EQ(value(film, 4, 12, 5), albedo_of(0.5F));
  EXPECT_FLOAT_EQ(value(film, 6, 12, 5), albedo_of(0.25F));
  const float share = value(film, 3, 13, 5);
  EXPECT_NEAR(share, 0.3, 1.0 / 16);
  EXPECT_FLOAT_EQ(value(film, 4, 13, 5), albedo_of(0.5F) * share);
  EXPECT_FLOAT_EQ(value(film, 5, 13, 5), share);
  for (std::size_t channel = 1; channel < 7; ++channel) EXPECT_EQ(value(film, channel, 14, 5), 0);
}

TEST(SampledAov, NoisyIsTheColor) {
  const std::vector<SampledAov> wanted = {SampledAov::noisy};
  const Film film = drawn_samples({.samples = 10, .sampled_aovs = wanted});
  const Film by_passes = drawn_samples({.samples = 10, .passes = Passes{}, .sampled_aovs = wanted});
  for (std::uint32_t x = 0; x < kSampledSize.width; ++x) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(value(film, c, x, 7), film.row(7)[x][static_cast<glm::length_t>(c)]);
      EXPECT_EQ(value(by_passes, c, x, 7), value(film, c, x, 7));
    }
  }
}

/// Renders the emission of a lamp that covers a quarter of a pixel.
Film lamp_picture(RenderOptions options) {
  Scene scene;
  scene.materials = {{.base_color = Vec4(0, 0, 0, 1), .emissive = Vec3(100)}};
  scene.objects = {{.name = "lamp", .shape = Sphere{{0.13F, -0.07F, -10}, 0.05F}, .material = 0}};
  static const PathIntegrator path;
  options.integrator = &path;
  options.sampled_aovs = {SampledAov::denoise_emission, SampledAov::emission};
  return render(scene, PerspectiveCamera{.vertical_fov = 0.35}, kSampledSize, options);
}

double sum_of(const Film& film, std::size_t channel) {
  const auto& values = std::get<std::vector<float>>(film.channels.at(channel).values);
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(SampledAov, DenoiseEmissionHasManySamplesOfLamps) {
  const Film exact = lamp_picture({.samples = 4096});
  EXPECT_EQ(sum_of(exact, 0), sum_of(exact, 3));
  for (const std::uint32_t samples : {1U, 16U}) {
    double sum = 0;
    constexpr int kSeeds = 8;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const Film film = lamp_picture({.samples = samples, .seed = seed});
      EXPECT_NEAR(sum_of(film, 0), sum_of(exact, 0), 0.4 * sum_of(exact, 0));
      sum += sum_of(film, 0) / kSeeds;
    }
    EXPECT_NEAR(sum, sum_of(exact, 0), 0.1 * sum_of(exact, 0)) << samples;
  }
}

TEST(SampledAov, PartsHaveTheDenoiseEmissionOfTheWhole) {
  const Film whole = lamp_picture({.samples = 2});
  const PixelRect part{.x0 = 3, .y0 = 5, .x1 = 18, .y1 = 15};
  const Film crop = lamp_picture({.samples = 2, .crop = part});
  const Film by_passes = lamp_picture({.samples = 2, .passes = Passes{}});
  const auto& values = std::get<std::vector<float>>(crop.channels.at(0).values);
  for (std::uint32_t y = part.y0, i = 0; y < part.y1; ++y) {
    for (std::uint32_t x = part.x0; x < part.x1; ++x, ++i)
      EXPECT_EQ(values[i], value(whole, 0, x, y));
  }
  EXPECT_EQ(by_passes.channels[0].values, whole.channels[0].values);
}

TEST(SampledAov, LampsAreFoundByAllCameras) {
  // Only a pinhole with a perspective projection allows choosing pixels.
  const std::vector<SampledAov> wanted = {SampledAov::denoise_emission, SampledAov::emission};
  Scene scene;
  scene.materials = {{.base_color = Vec4(0, 0, 0, 1), .emissive = Vec3(1)}};
  scene.objects = {
      {.name = "lamp", .shape = Disc{{0.03F, 0.03F, -2}, {0, 0, 1}, 0.02F}, .material = 0},
      {.name = "behind", .shape = Sphere{{0, 0, 5}, 1}, .material = 0}};
  const Pose pose{};
  for (const Camera& camera :
       {Camera(PerspectiveCamera{.pose = pose}), Camera(OrthographicCamera{.pose = pose}),
        Camera(EnvironmentCamera{.pose = pose}),
        Camera(PerspectiveCamera{.pose = pose, .focus = 2, .lens_radius = 0.01})}) {
    static const PathIntegrator path;
    const auto film = [&](std::uint32_t samples) {
      return render(scene, camera, kSampledSize,
                    {.integrator = &path, .samples = samples, .sampled_aovs = wanted});
    };
    const double exact = sum_of(film(4096), 3);
    EXPECT_GT(exact, 0) << camera.index();
    EXPECT_NEAR(sum_of(film(1), 0), exact, 0.5 * exact) << camera.index();
  }
}

/// Renders the emission and the features of what a camera at the origin sees.
Film seen_features(Scene scene, RenderOptions options) {
  static const PathIntegrator path;
  if (options.integrator == nullptr) options.integrator = &path;
  options.sampled_aovs = {SampledAov::denoise_albedo, SampledAov::denoise_normal,
                          SampledAov::emission};
  scene.epsilon = 0;
  return render(scene, PerspectiveCamera{.vertical_fov = 0.1}, {.width = 2, .height = 2}, options);
}

Vec3 vector_at(const Film& film, std::size_t first) {
  Vec3 result;
  for (glm::length_t c = 0; c < 3; ++c)
    result[c] = std::get<std::vector<float>>(
        film.channels.at(first + static_cast<std::size_t>(c)).values)[0];
  return result;
}

void expect_near(const Vec3& actual, const Vec3& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], 2e-3) << c;
}

/// A colored wall behind the camera at z = 5, and one in front of it at z = -5.
Scene two_walls() {
  Scene scene;
  scene.materials = {{.base_color = Vec4(0.5F, 0.25F, 0.125F, 1), .roughness = 1},
                     {.base_color = Vec4(0.2F, 0.6F, 0.9F, 1), .roughness = 1}};
  scene.objects = {{.name = "behind", .shape = Plane{{0, 0, 5}, {0, 0, -1}}, .material = 0},
                   {.name = "front", .shape = Plane{{0, 0, -5}, {0, 0, 1}}, .material = 1}};
  return scene;
}

constexpr Vec3 kBehind{0.52F, 0.28F, 0.16F}, kFront{0.232F, 0.616F, 0.904F};

TEST(Features, MirrorsShowOtherSurfaces) {
  Scene scene = two_walls();
  scene.materials.push_back({.base_color = Vec4(0.5F, 1, 1, 1), .metallic = 1, .roughness = 0.1F});
  scene.objects.push_back(
      {.name = "mirror", .shape = Disc{{0, 0, -2}, {0, 0, 1}, 1}, .material = 2});
  const Film film = seen_features(scene, {});
  expect_near(vector_at(film, 0), Vec3(0.5F, 1, 1) * kBehind);
  expect_near(vector_at(film, 3), {0, 0, -1});
  scene.materials[2].roughness = 0.5F;
  const Film rough = seen_features(scene, {});
  expect_near(vector_at(rough, 0), {0.5F, 1, 1});
  expect_near(vector_at(rough, 3), {0, 0, 1});
}

TEST(Features, GlassShowsWhatIsBehindAndReflected) {
  Scene scene = two_walls();
  scene.materials.push_back({.base_color = Vec4(0.8F, 1, 1, 1), .metallic = 0, .roughness = 0});
  scene.materials[2].transmission = Transmission{.factor = 1};
  scene.materials[2].double_sided = true;
  scene.objects.push_back({.name = "pane", .shape = Disc{{0, 0, -2}, {0, 0, 1}, 1}, .material = 2});
  // The reflection of 4 % is too faint to be followed.
  expect_near(vector_at(seen_features(scene, {}), 0), Vec3(0.8F, 1, 1) * kFront);
  // Reflects ((2.5 - 1) / (2.5 + 1))^2 = 0.1837 of the light. Shares below 0.05 are subtracted.
  scene.materials[2].ior = 2.5F;
  const float share = (0.1837F - 0.05F) / 0.95F;
  const Film film = seen_features(scene, {});
  expect_near(vector_at(film, 0), share * kBehind + (1 - share) * Vec3(0.8F, 1, 1) * kFront);
  expect_near(vector_at(film, 3), {0, 0, 1 - 2 * share});
}

// The front wall in a medium that begins at z = -2 and scatters light before it reaches the wall.
TEST(Features, ScatteringMediaShowTheirColor) {
  Scene scene = two_walls();
  Material medium{.roughness = 0};
  medium.transmission = Transmission{.factor = 1};
  medium.volume = Volume{.thickness = 1, .attenuation_distance = 3};
  medium.volume->attenuation_color = {0.5F, 0.2F, 0.1F};
  medium.volume_scatter = VolumeScatter{.multiscatter_color = {0.9F, 0.8F, 0.3F}};
  scene.materials.push_back(medium);
  scene.objects.push_back(
      {.name = "surface", .shape = Plane{{0, 0, -2}, {0, 0, 1}}, .material = 2});
  const Vec3 left = medium.volume->attenuation_color;
  const Film film = seen_features(scene, {});
  expect_near(vector_at(film, 0), left * kFront + (Vec3(1) - left) * Vec3(0.9F, 0.8F, 0.3F));
  expect_near(vector_at(film, 3), {0, 0, 1});
}

TEST(Features, RefractionBendsRays) {
  // From the left half of a glass ball, the camera sees the right wall.
  Scene scene;
  scene.materials = {{.base_color = Vec4(1, 0, 0, 1), .roughness = 1},
                     {.base_color = Vec4(0, 1, 0, 1), .roughness = 1},
                     {.metallic = 0, .roughness = 0}};
  scene.materials[2].transmission = Transmission{.factor = 1};
  scene.materials[2].volume = Volume{.thickness = 1};
  scene.objects = {{.name = "left", .shape = Plane{{-3, 0, 0}, {1, 0, 0}}, .material = 0},
                   {.name = "right", .shape = Plane{{3, 0, 0}, {-1, 0, 0}}, .material = 1},
                   {.name = "ball", .shape = Sphere{{0.5F, 0, -3}, 1}, .material = 2}};
  const Vec3 albedo = vector_at(seen_features(scene, {}), 0);
  EXPECT_GT(albedo.y, 0.9F);
  EXPECT_LT(albedo.x, 0.1F);
}

TEST(Features, LampsAreEmissionWhereTheyAreSeenDirectly) {
  Scene scene = two_walls();
  scene.background = Vec3(0.7F);
  scene.materials[1].emissive = Vec3(6, 3, 0);
  const Film lamp = seen_features(scene, {.samples = 3});
  EXPECT_EQ(vector_at(lamp, 6), Vec3(6, 3, 0));
  expect_near(vector_at(lamp, 0), kFront);
  scene.materials.push_back({.metallic = 1, .roughness = 0});
  scene.materials[0].emissive = Vec3(6, 3, 0);
  scene.objects.push_back(
      {.name = "mirror", .shape = Disc{{0, 0, -2}, {0, 0, 1}, 1}, .material = 2});
  const Film mirrored = seen_features(scene, {.samples = 3});
  EXPECT_EQ(vector_at(mirrored, 6), Vec3(0));
  const Vec3 sum = kBehind + Vec3(6, 3, 0);
  expect_near(vector_at(mirrored, 0), sum / sum.x);
  scene.objects.clear();
  const Film empty = seen_features(scene, {.samples = 3});
  EXPECT_EQ(vector_at(empty, 0), Vec3(0));
  EXPECT_EQ(vector_at(empty, 3), Vec3(0));
  EXPECT_EQ(vector_at(empty, 6), Vec3(0.7F));
}

// Emission includes a background with the shadows on a ground, so that the rest of the color, which
// is denoised, is not negative where a surface covers part of a pixel.
TEST(SampledAov, EmissionIncludesShadowsOnAGround) {
  Scene scene;
  scene.background = Vec3(0.8F);
  scene.environment = Environment{};
  scene.materials = {{.base_color = Vec4(0.1F, 0.1F, 0.1F, 0.3F), .alpha_mode = AlphaMode::blend},
                     {.base_color = Vec4(0, 0, 0, 1)}};
  scene.objects.push_back({.name = "veil",
                           .shape = Disc{.center = {0, 0.2F, 0}, .normal = {0, 1, 0}, .radius = 2},
                           .material = 0});
  scene.objects.push_back(
      {.name = "ball", .shape = Sphere{.center = {0, 1, 0}, .radius = 1}, .material = 1});
  const PathIntegrator paths({.ground = Ground{}});
  const Film film =
      render(scene, PerspectiveCamera{.pose = {.position = {0, 4, 6}, .direction = {0, -0.6, -1}}},
             kSampledSize,
             {.integrator = &paths,
              .samples = 32,
              .sampled_aovs = {SampledAov::emission, SampledAov::noisy}});
  int shadows = 0;
  for (std::uint32_t y = 0; y < kSampledSize.height; ++y) {
    for (std::uint32_t x = 0; x < kSampledSize.width; ++x) {
      const float emission = value(film, 0, x, y), color = value(film, 3, x, y);
      ASSERT_LE(emission, color + 1e-6F) << x << " " << y;
      shadows += emission > 0.1F && emission < 0.7F ? 1 : 0;
    }
  }
  EXPECT_GT(shadows, 50);
}

TEST(SampledAov, NamesAreThoseOfTheCommandLine) {
  for (const SampledAov aov : kSampledAovs) EXPECT_EQ(sampled_aov_named(name_of(aov)), aov);
  EXPECT_EQ(sampled_aov_named("depth"), std::nullopt);
}

TEST(SampledAov, NeedARandomIntegratorAndNoDuplicates) {
  const FlatIntegrator flat;
  EXPECT_THROW((void)drawn_samples({.integrator = &flat, .sampled_aovs = {SampledAov::samples}}),
               Error);
  EXPECT_THROW((void)drawn_samples({.sampled_aovs = {SampledAov::samples, SampledAov::samples}}),
               Error);
}

}  // namespace
}  // namespace microtrace
