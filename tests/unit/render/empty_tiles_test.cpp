// Compares pictures whose empty tiles are filled without tracing with pictures of which each ray is
// traced.

#include "support/pictures.hpp"

#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr ImageSize kTiledSize{.width = 93, .height = 70};

/// Traces each ray as PathIntegrator does.
class TracingIntegrator final : public Integrator {
 public:
  explicit TracingIntegrator(const PathOptions& options) : path_(options) {}
  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    path_.trace(world, rays, ids, samples);
  }
  [[nodiscard]] bool is_random() const override { return true; }
  [[nodiscard]] RayCounts ray_counts() const override { return path_.ray_counts(); }

 private:
  PathIntegrator path_;
};

/// A sheet and a small triangle in the left half of the picture, of which tiles may show an edge.
Scene sheet() {
  Scene scene;
  scene.materials = {{.base_color = {0.5F, 0.6F, 0.7F, 1}}};
  scene.objects.push_back(
      {.shape = parallelogram({-0.9F, -0.5F, -3}, {0.8F, 0.1F, 0}, {-0.1F, 1, 0}), .material = 0});
  scene.objects.push_back(
      {.shape = Triangle{{0.31F, 0.3F, -2}, {0.32F, 0.3F, -2}, {0.31F, 0.31F, -2}}});
  scene.environment = Environment{.content = Vec3(0.25F, 0.5F, 0.125F)};
  return scene;
}

struct Picture {
  std::vector<DVec3> pixels;
  std::vector<float> alphas;
  std::uint64_t camera_rays;

  Picture(const Scene& scene, const Camera& camera, const Integrator& integrator,
          RenderOptions options) {
    options.threads = 1;
    options.integrator = &integrator;
    options.samples = 5;
    const Film film = render(scene, camera, kTiledSize, options);
    pixels = pixels_of(film);
    for (std::uint32_t y = 0; film.has_alpha() && y < film.size().height; ++y)
      alphas.insert(alphas.end(), film.alpha_row(y).begin(), film.alpha_row(y).end());
    camera_rays = integrator.ray_counts().camera.rays;
  }
};

/// Returns the fraction of camera rays that are traced.
double traced(const Scene& scene, const Camera& camera, const RenderOptions& options = {},
              const PathOptions& path_options = {}) {
  const Picture expected(scene, camera, TracingIntegrator(path_options), options);
  const Picture picture(scene, camera, PathIntegrator(path_options), options);
  EXPECT_TRUE(picture.pixels == expected.pixels);
  EXPECT_TRUE(picture.alphas == expected.alphas);
  return static_cast<double>(picture.camera_rays) / static_cast<double>(expected.camera_rays);
}

TEST(EmptyTiles, HaveTheSamplesOfRaysThatMiss) {
  const PerspectiveCamera camera;
  for (const PixelFilter filter : {PixelFilter::box, PixelFilter::blackman_harris}) {
    for (const bool transparent : {false, true}) {
      const RenderOptions options{.filter = filter, .transparent = transparent};
      EXPECT_LT(traced(sheet(), camera, options), 0.6);
      Scene seen = sheet();
      seen.environment->is_background = true;
      EXPECT_LT(traced(seen, camera, options), 0.6);
      Scene dark = sheet();
      dark.environment.reset();
      dark.lights.push_back(
          {.name = "", .light = PointLight{.position = {0, 0, 0}, .intensity = 10}});
      EXPECT_LT(traced(dark, camera, options), 0.6);
    }
  }
}

TEST(EmptyTiles, AreTracedWhereRaysDiffer) {
  const PerspectiveCamera camera;
  Scene studio = sheet();
  studio.environment = Environment{.content = Studio{}};
  studio.environment->is_background = true;
  EXPECT_EQ(traced(studio, camera), 1);
  EXPECT_EQ(traced(sheet(), camera, {}, {.ground = Ground{}}), 1);
  EXPECT_EQ(traced(sheet(), PerspectiveCamera{.lens_radius = 0.1}), 1);
  Scene wall = sheet();
  wall.objects.push_back({.shape = Plane{.point = {0, 0, -9}, .normal = {0, 0, 1}}});
  EXPECT_EQ(traced(wall, camera), 1);
}

}  // namespace
}  // namespace microtrace
