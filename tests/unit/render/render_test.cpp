#include <microtrace/aov.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/error.hpp>
#include <microtrace/film_view.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <numbers>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr Vec3 kNear{1, 0, 0}, kFar{0, 0, 1}, kRenderBackground{0, 1, 0};

// Renders one pixel that looks along -z at two discs, at the distances 4 and 6.
Vec3 pixel(float epsilon, const PerspectiveCamera& camera = {}) {
  Scene scene;
  scene.background = kRenderBackground;
  scene.epsilon = epsilon;
  scene.materials = {{.base_color = Vec4(kNear, 1)}, {.base_color = Vec4(kFar, 1)}};
  scene.objects.push_back({.name = "near", .shape = Disc{{0, 0, -4}, {0, 0, 1}, 1}, .material = 0});
  scene.objects.push_back({.name = "far", .shape = Disc{{0, 0, -6}, {0, 0, 1}, 1}, .material = 1});
  return render(scene, camera, {.width = 1, .height = 1}, {.threads = 1}).row(0)[0];
}

/// Returns the error of render().
Error error_of(const Camera& camera, ImageSize size, const RenderOptions& options) {
  try {
    (void)render(Scene{}, camera, size, options);
  } catch (const Error& error) {
    return error;
  }
  return {ErrorKind::internal, "", "nothing was thrown"};
}

TEST(Render, RefusesEnvironmentsCamerasAndSizesThatItCantUse) {
  const PathIntegrator path;
  const auto of_map = [&](std::shared_ptr<const RadianceMap> map) {
    return error_of(PerspectiveCamera{}, {.width = 2, .height = 2},
                    {.integrator = &path, .environment = Environment{.content = std::move(map)}});
  };
  const Vec3 nan(std::numeric_limits<float>::quiet_NaN());
  for (const Error& error :
       {of_map(nullptr), of_map(std::make_shared<RadianceMap>()),
        of_map(std::make_shared<RadianceMap>(RadianceMap{.width = 9, .height = 9})),
        of_map(std::make_shared<RadianceMap>(
            RadianceMap{.width = 1, .height = 1, .pixels = {nan}}))}) {
    EXPECT_EQ(error.kind(), ErrorKind::invalid_scene);
    EXPECT_EQ(error.diagnostic().pointer, "/environment/content");
  }
  const Error parallel =
      error_of(PerspectiveCamera{.pose = {.direction = {0, 1, 0}}}, {.width = 2, .height = 2}, {});
  EXPECT_EQ(parallel.kind(), ErrorKind::invalid_scene);
  EXPECT_EQ(parallel.diagnostic().pointer, "/camera/up");
  EXPECT_EQ(error_of(PerspectiveCamera{}, {.width = 0, .height = 5}, {}).kind(), ErrorKind::usage);
  EXPECT_EQ(error_of(PerspectiveCamera{}, {.width = ~0U, .height = ~0U}, {}).kind(),
            ErrorKind::limit);
}

TEST(Render, HitsLieInTheOpenIntervalFromEpsilon) {
  EXPECT_EQ(pixel(0), kNear);
  EXPECT_EQ(pixel(std::nextafter(4.0F, 0.0F)), kNear);
  EXPECT_EQ(pixel(4), kFar);
  EXPECT_EQ(pixel(std::nextafter(6.0F, 0.0F)), kFar);
  EXPECT_EQ(pixel(6), kRenderBackground);
}

TEST(Render, CameraSeesItsDepthRange) {
  EXPECT_EQ(pixel(0, {.depth = {.near = 4, .far = 10}}), kNear);
  EXPECT_EQ(pixel(0, {.depth = {.near = 4.5, .far = 10}}), kFar);
  EXPECT_EQ(pixel(0, {.depth = {.near = 4.5, .far = 5.5}}), kRenderBackground);
}

TEST(Render, EmptyPicturesAreFoundBeforeTheBackgroundOfTheOptions) {
  Scene scene;
  scene.objects.push_back({.name = "behind", .shape = Sphere{{0, 0, 9}, 1}});
  const PreparedScene prepared(scene);
  const auto is_empty = [&](const RenderOptions& options) {
    const Film film = render(prepared, PerspectiveCamera{}, {.width = 4, .height = 3}, options);
    return view_of(film, prepared, PerspectiveCamera{}, options).is_empty;
  };
  const PathIntegrator path;
  EXPECT_TRUE(is_empty({}));
  EXPECT_TRUE(is_empty({.background = Vec3(0.25F)}));
  EXPECT_TRUE(is_empty({.integrator = &path, .background = Vec3(0.25F)}));
  Environment sky{.content = Vec3(0.25F)};
  EXPECT_TRUE(is_empty({.integrator = &path, .environment = sky}));
  sky.is_background = true;
  EXPECT_FALSE(is_empty({.integrator = &path, .environment = sky}));
}

TEST(Render, ProgressEndsAtOne) {
  Scene scene;
  double last = 0;
  int calls = 0;
  const auto progress = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    ++calls;
    return true;
  };
  (void)render(scene, PerspectiveCamera{}, {.width = 200, .height = 100},
               {.threads = 2, .progress = progress});
  EXPECT_EQ(last, 1);
  EXPECT_GT(calls, 10);
}

TEST(Render, StopsWithinATile) {
  const PathIntegrator path;
  for (const unsigned threads : {1U, 3U}) {
    RenderOptions options{.threads = threads, .integrator = &path, .samples = kMaxSamples};
    options.progress = [](double share) {
      EXPECT_EQ(share, 0);
      return false;
    };
    EXPECT_THROW((void)render(Scene{}, PerspectiveCamera{}, {.width = 8, .height = 8}, options),
                 Error);
  }
}

TEST(Render, ExceptionsOfThreadsReachTheCaller) {
  const auto progress = [](double) -> bool { throw std::runtime_error("stop"); };
  EXPECT_THROW((void)render(Scene{}, PerspectiveCamera{}, {.width = 200, .height = 100},
                            {.threads = 2, .progress = progress}),
               std::runtime_error);
}

TEST(Render, StopsIfProgressReturnsFalse) {
  for (const unsigned threads : {1U, 3U}) {
    int calls = 0;
    const auto progress = [&](double) { return ++calls < 3; };
    try {
      (void)render(Scene{}, PerspectiveCamera{}, {.width = 400, .height = 300},
                   {.threads = threads, .progress = progress});
      FAIL() << "was not canceled";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::canceled);
    }
    // The callback is not called again after it cancels.
    EXPECT_EQ(calls, 3);
  }
}

TEST(Render, PixelsWithoutRaysAreBlackOrTransparent) {
  // A fisheye camera inside an emissive sphere, and an environment. The image circle has a radius
  // of 10 pi pixels.
  Scene scene;
  scene.background = Vec3(0.5F);
  scene.environment = Environment{.content = Vec3(0.25F), .is_background = true};
  scene.objects.push_back({.name = "", .shape = Sphere{{0, 0, 0}, 3}, .material = 0});
  scene.materials.push_back({.emissive = Vec3(1)});
  const ImageSize size{.width = 100, .height = 80};
  const Camera camera = CalibratedCamera{
      .image = size, .fx = 10, .fy = 10, .cx = 49.5, .cy = 39.5, .distortion = FisheyeDistortion{}};
  const auto distance_to_circle = [](double x, double y) {
    return std::hypot(x + 0.5 - 50, y + 0.5 - 40) - 10 * std::numbers::pi;
  };
  const PathIntegrator path(PathOptions{});
  const AovIntegrator depth(Aov::distance);
  for (const bool has_surface : {true, false}) {
    if (!has_surface) scene.objects.clear();
    for (const bool transparent : {false, true}) {
      const RenderOptions options{
          .threads = 1, .aovs = {Aov::depth, Aov::id}, .transparent = transparent};
      RenderOptions path_options = options;
      path_options.integrator = &path;
      Film flat = render(scene, camera, size, options);
      Film lit = render(scene, camera, size, path_options);
      Film numbers = render(scene, camera, size,
                            {.threads = 1, .integrator = &depth, .transparent = transparent});
      const auto& depths = std::get<std::vector<float>>(flat.channels.at(0).values);
      const auto& ids = std::get<std::vector<std::uint32_t>>(flat.channels.at(1).values);
      for (std::uint32_t y = 0; y < size.height; ++y) {
        for (std::uint32_t x = 0; x < size.width; ++x) {
          const double distance = distance_to_circle(x, y);
          const bool outside = distance > 0;
          const bool shows = !outside && has_surface;
          const std::size_t i = std::size_t{y} * size.width + x;
          EXPECT_EQ(std::isinf(depths[i]), !shows) << x << " " << y;
          EXPECT_EQ(ids[i], shows ? 1 : 0);
          EXPECT_EQ(std::isinf(numbers.at(x, y).x), !shows);
          EXPECT_EQ(flat.at(x, y) == Vec3(0), outside || (transparent && !has_surface));
          if (transparent) {
            EXPECT_EQ(flat.alpha_at(x, y), shows ? 1 : 0);
          }
          if (std::abs(distance) < 1) continue;  // path tracing jitters positions within the pixel
          EXPECT_EQ(lit.at(x, y) == Vec3(0), outside) << x << " " << y;
          if (transparent) {
            EXPECT_EQ(lit.alpha_at(x, y), outside ? 0 : 1);
          }
        }
      }
    }
  }
}

TEST(Render, RunsOnTheThreadsOfTheHost) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = Sphere{{0, 0, -5}, 1}});
  const ImageSize size{.width = 60, .height = 40};
  const Film own = render(scene, PerspectiveCamera{}, size, {.threads = 1});
  const auto caller = std::this_thread::get_id();
  std::set<std::thread::id> drew;
  std::mutex mutex;
  unsigned calls = 0;
  RenderOptions options{.threads = 3};
  options.run_threads = [&](unsigned threads, const std::function<void()>& work) {
    ++calls;
    EXPECT_EQ(threads, 3U);
    std::vector<std::jthread> host;
    for (unsigned i = 0; i < threads; ++i) host.emplace_back(work);
  };
  options.progress = [&](double) {
    const std::scoped_lock lock(mutex);
    drew.insert(std::this_thread::get_id());
    return true;
  };
  const Film hosted = render(scene, PerspectiveCamera{}, size, options);
  EXPECT_EQ(calls, 1U);
  EXPECT_FALSE(drew.contains(caller));
  for (std::uint32_t y = 0; y < size.height; ++y)
    EXPECT_TRUE(std::ranges::equal(own.row(y), hosted.row(y))) << y;
}

}  // namespace
}  // namespace microtrace
