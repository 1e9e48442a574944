#include <microtrace/render.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr Vec3 kNear{1, 0, 0}, kFar{0, 0, 1}, kBackground{0, 1, 0};

// The only pixel looks along -z at discs at distances 4 and 6.
Vec3 pixel(float epsilon, const PerspectiveCamera& camera = {}) {
  Scene scene;
  scene.background = kBackground;
  scene.epsilon = epsilon;
  scene.materials = {{.base_color = Vec4(kNear, 1)}, {.base_color = Vec4(kFar, 1)}};
  scene.objects.push_back({.name = "near", .shape = Disc{{0, 0, -4}, {0, 0, 1}, 1}, .material = 0});
  scene.objects.push_back({.name = "far", .shape = Disc{{0, 0, -6}, {0, 0, 1}, 1}, .material = 1});
  return render(scene, camera, {.width = 1, .height = 1}, {.threads = 1}).row(0)[0];
}

TEST(Render, HitsLieInTheOpenIntervalFromEpsilon) {
  EXPECT_EQ(pixel(0), kNear);
  EXPECT_EQ(pixel(std::nextafter(4.0F, 0.0F)), kNear);
  EXPECT_EQ(pixel(4), kFar);
  EXPECT_EQ(pixel(std::nextafter(6.0F, 0.0F)), kFar);
  EXPECT_EQ(pixel(6), kBackground);
}

TEST(Render, CameraSeesBetweenItsDepths) {
  EXPECT_EQ(pixel(0, {.depth = {.near = 4, .far = 10}}), kNear);
  EXPECT_EQ(pixel(0, {.depth = {.near = 4.5, .far = 10}}), kFar);
  EXPECT_EQ(pixel(0, {.depth = {.near = 4.5, .far = 5.5}}), kBackground);
}

TEST(Render, ProgressEndsAtOne) {
  Scene scene;
  double last = 0;
  int calls = 0;
  const auto progress = [&](double share) {
    EXPECT_GT(share, 0);
    EXPECT_LE(share, 1);
    last = std::max(last, share);
    ++calls;
  };
  (void)render(scene, PerspectiveCamera{}, {.width = 200, .height = 100},
               {.threads = 2, .progress = progress});
  EXPECT_EQ(last, 1);
  EXPECT_GT(calls, 10);
}

TEST(Render, ExceptionsOfThreadsArrive) {
  const auto progress = [](double) { throw std::runtime_error("stop"); };
  EXPECT_THROW((void)render(Scene{}, PerspectiveCamera{}, {.width = 200, .height = 100},
                            {.threads = 2, .progress = progress}),
               std::runtime_error);
}

}  // namespace
}  // namespace microtrace
