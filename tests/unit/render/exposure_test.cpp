#include <microtrace/defaults.hpp>
#include <microtrace/exposure.hpp>
#include <microtrace/path.hpp>

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kExposureSize{.width = 640, .height = 480};

/// A plane that fills the picture and emits this radiance in its green channel.
Scene glowing(float radiance) {
  Scene scene;
  scene.environment = Environment{.content = Vec3(0)};
  scene.materials = {{.base_color = Vec4(0, 0, 0, 1), .emissive = Vec3(0, radiance, 0)}};
  scene.objects = {{.shape = Plane{{0, 0, -1}, {0, 0, 1}}, .material = 0}};
  return scene;
}

double exposure_of(Scene scene, ImageSize size = kExposureSize, RenderOptions options = {}) {
  const PathIntegrator path;
  if (options.integrator == nullptr) options.integrator = &path;
  const PreparedScene prepared(std::move(scene));
  return automatic_exposure(prepared, PerspectiveCamera{}, size, options);
}

/// Returns the multiple of 1/10 that is nearest to 0 and maps the radiance into [1/8, 1].
double expected(double radiance) {
  const double least = std::log2(0.125 / radiance), most = std::log2(1 / radiance);
  if (least > 0) return std::ceil(10 * least - 1e-4) / 10;
  return most < 0 ? std::floor(10 * most + 1e-4) / 10 : 0;
}

TEST(AutomaticExposure, MapsTheSurfacesIntoTheRangeOfAPicture) {
  for (const double radiance : {0.125, 0.5, 1.0, 0.124, 1.01, 3.7, 8.0, 1e5, 1e12, 1e-5})
    EXPECT_DOUBLE_EQ(exposure_of(glowing(static_cast<float>(radiance))), expected(radiance))
        << radiance;
  EXPECT_EQ(exposure_of(glowing(0)), 0);
}

TEST(AutomaticExposure, IgnoresTheBackgroundAndAFewBrightPixels) {
  Scene scene = glowing(0);
  scene.background = Vec3(100);
  scene.materials = {{.base_color = Vec4(0.03125F, 0, 0, 1), .unlit = true},
                     {.emissive = Vec3(1000)}};
  scene.objects = {{.shape = Sphere{{0, 0, -5}, 1.5F}, .material = 0},
                   {.shape = Sphere{{0, 0, -3}, 0.1F}, .material = 1}};  // covers 1 %
  EXPECT_DOUBLE_EQ(exposure_of(scene), 2);
  const Environment visible{.content = Vec3(100), .is_background = true};
  EXPECT_DOUBLE_EQ(exposure_of(scene, kExposureSize, {.environment = visible}), 2);
  scene.environment = visible;
  EXPECT_DOUBLE_EQ(exposure_of(scene), 2);
  scene.environment = Environment{.content = Vec3(0)};
  scene.objects[1].shape = Sphere{{0, 0, -3}, 0.5F};
  EXPECT_DOUBLE_EQ(exposure_of(scene), expected(1000));
}

TEST(AutomaticExposure, DependsOnNeitherSamplesNorSeedNorCropNorThreads) {
  Scene scene = glowing(0);
  scene.environment = Environment{.content = Vec3(40)};
  scene.materials[0].base_color = Vec4(0.5F, 0.4F, 0.3F, 1);
  scene.objects.push_back({.shape = Sphere{{0, 0, -0.8F}, 0.1F}, .material = 0});
  const double exposure = exposure_of(scene);
  EXPECT_LT(exposure, -3);
  EXPECT_EQ(exposure, exposure_of(scene, kExposureSize, {.threads = 3, .samples = 7, .seed = 5}));
  EXPECT_EQ(exposure, exposure_of(scene, kExposureSize, {.crop = PixelRect{0, 0, 5, 5}}));
  EXPECT_EQ(exposure, exposure_of(scene, {.width = 1280, .height = 960}));
  EXPECT_NO_THROW((void)exposure_of(scene, {.width = 1, .height = 65536}));
}

TEST(AutomaticExposure, IsZeroForPicturesOfQuantities) {
  const auto depth = make_integrator(Aov::depth);
  EXPECT_EQ(exposure_of(glowing(100), kExposureSize, {.integrator = depth.get()}), 0);
}

}  // namespace
}  // namespace microtrace
