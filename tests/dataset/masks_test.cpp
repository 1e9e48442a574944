#include "dataset/annotations/masks.hpp"

#include "views.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace microtrace::dataset::tests {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

std::set<Pixel> block(std::uint32_t x0, std::uint32_t y0, std::uint32_t x1, std::uint32_t y1) {
  std::set<Pixel> pixels;
  for (std::uint32_t y = y0; y < y1; ++y) {
    for (std::uint32_t x = x0; x < x1; ++x) pixels.emplace(y, x);
  }
  return pixels;
}

TEST(Masks, OverlappingRectanglesHaveTheirWholeAmodalMasks) {
  Scene scene;
  scene.objects = {rectangle("back", {-6, -3, 0}, 8, 4), rectangle("front", {-1, -2, 1}, 5, 5)};
  const ImageSize size{.width = 16, .height = 10};
  const RenderedView view(scene, unit_camera(size), size);
  const Masks visible = view.visible(), amodal = view.amodal();
  // In pixels, x grows by 8, and y is 5 minus the height.
  const std::set<Pixel> back = block(2, 4, 10, 8), front = block(7, 2, 12, 7);
  ASSERT_THAT(visible, SizeIs(2));
  ASSERT_THAT(amodal, SizeIs(2));
  EXPECT_EQ(pixels_of(amodal[0].mask), back);
  EXPECT_EQ(pixels_of(amodal[1].mask), front);
  EXPECT_EQ(pixels_of(visible[1].mask), front);
  std::set<Pixel> rest;
  std::ranges::set_difference(back, front, std::inserter(rest, rest.end()));
  EXPECT_EQ(pixels_of(visible[0].mask), rest);
  EXPECT_EQ(visible[0].mask.area(), rest.size());
  EXPECT_EQ(visible[0].mask.box(), (PixelRect{.x0 = 2, .y0 = 4, .x1 = 10, .y1 = 8}));
}

TEST(Masks, HiddenObjectHasAnAmodalMaskOnly) {
  Scene scene;
  scene.objects = {rectangle("front", {-4, -4, 1}, 8, 8), rectangle("hidden", {-1, -1, 0}, 2, 2)};
  const RenderedView view(scene, unit_camera({.width = 8, .height = 8}), {.width = 8, .height = 8});
  EXPECT_EQ(find_mask(view.visible(), 1), nullptr);
  const Masks amodal = view.amodal();
  ASSERT_NE(find_mask(amodal, 1), nullptr);
  EXPECT_EQ(pixels_of(*find_mask(amodal, 1)), block(3, 3, 5, 5));
}

TEST(Masks, EmptyOnePixelAndFullViews) {
  Scene scene;
  const RenderedView empty(scene, unit_camera({.width = 3, .height = 5}),
                           {.width = 3, .height = 5});
  EXPECT_THAT(empty.visible(), IsEmpty());
  EXPECT_THAT(empty.amodal(), IsEmpty());
  scene.objects = {rectangle("all", {-50, -50, 0}, 100, 100)};
  for (const ImageSize size :
       {ImageSize{.width = 1, .height = 1}, ImageSize{.width = 9, .height = 2}}) {
    const RenderedView view(scene, unit_camera(size), size);
    for (const Masks& masks : {view.visible(), view.amodal()}) {
      ASSERT_THAT(masks, SizeIs(1));
      EXPECT_EQ(pixels_of(masks[0].mask), block(0, 0, size.width, size.height));
      EXPECT_THAT(masks[0].mask.runs(), SizeIs(size.height));
    }
  }
}

TEST(Masks, ViewsThatDoNotFitAreRefused) {
  Scene scene;
  const RenderedView rendered(scene, unit_camera({.width = 2, .height = 2}),
                              {.width = 2, .height = 2});
  DrawnView view = rendered.view();
  view.size.width = 3;
  EXPECT_THROW(static_cast<void>(visible_masks(view)), Error);
  const std::vector<std::uint32_t> objects{0, kNoObject, kNoObject, kNoObject};
  view.size.width = 2;
  view.objects = objects;
  EXPECT_THROW(static_cast<void>(visible_masks(view)), Error);
}

/// Spheres, planes, touching, coinciding and culled triangles, and a mask of alpha.
Scene adversarial_scene(unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 1025) / 1024;
  };
  Scene scene;
  scene.origin = {1e6, -3e5, 7};
  scene.epsilon = 0.5F;
  Image image{.width = 4, .height = 4, .channels = 4};
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 64; ++i) bytes.push_back(static_cast<std::uint8_t>(random() >> 8));
  image.samples = bytes;
  scene.images = {std::make_shared<const Image>(image)};
  scene.textures = {Texture{.image = 0}};
  Material one_sided, masked;
  one_sided.double_sided = false;
  masked.alpha_mode = AlphaMode::mask;
  masked.double_sided = false;
  masked.base_color_texture = TextureUse{.texture = 0};
  scene.materials = {Material{}, one_sided, masked};
  for (std::uint32_t k = 0; k < 30; ++k) {
    const Vec3 p(number(-4, 4), number(-4, 4), number(-4, 9));
    Object object{.name = std::to_string(k), .shape = Sphere{.center = p, .radius = number(0, 2)}};
    if (k % 3 != 0) {
      // Corners on a coarse grid, so that triangles of several objects share edges and planes.
      Mesh mesh;
      std::vector<Vec3> corners;
      std::vector<Vec2> uvs;
      for (int i = 0; i < 9; ++i) {
        corners.emplace_back(std::round(number(-4, 4)), std::round(number(-4, 4)),
                             std::round(number(-1, 3)));
        uvs.emplace_back(number(0, 1), number(0, 1));
      }
      mesh.positions = corners;
      mesh.uv_sets.emplace_back(uvs);
      mesh.triangles =
          std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {2, 1, 3}};
      object.shape = mesh;
    }
    object.material = k % 3;
    scene.objects.push_back(object);
  }
  scene.objects.push_back(scene.objects[1]);  // coincides
  scene.objects.push_back({.name = "plane", .shape = Plane{.point = {0, -1, 0}}, .material = 1});
  return scene;
}

std::vector<Camera> cameras() {
  const Pose pose{.position = {0.25, 0.5, 10}, .direction = {0, -0.1, -1}};
  CalibratedCamera calibrated{.pose = pose, .image = {.width = 40, .height = 30}};
  calibrated.fx = calibrated.fy = 30;
  calibrated.cx = 19.5;
  calibrated.cy = 14.5;
  calibrated.distortion = RationalDistortion{.k1 = -0.6};  // pixels in the corners have no rays
  return {PerspectiveCamera{.pose = pose},
          OrthographicCamera{.pose = {.position = {0, 0, 10}}, .height = 8},
          EnvironmentCamera{.pose = {.position = {0, 0, 1}}}, calibrated};
}

TEST(Masks, AmodalMaskIsWhatTheObjectWouldCoverAlone) {
  const ImageSize size{.width = 45, .height = 33};
  std::size_t hidden = 0;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Scene scene = adversarial_scene(seed);
    for (const Camera& camera : cameras()) {
      const RenderedView view(scene, camera, size);
      const Masks amodal = view.amodal(), visible = view.visible();
      for (std::uint32_t k = 0; k < scene.objects.size(); ++k) {
        Scene alone = scene;
        alone.objects = {scene.objects[k]};
        const Masks expected = RenderedView(alone, camera, size).visible();
        const Mask* mask = find_mask(amodal, k);
        ASSERT_EQ(mask != nullptr, !expected.empty()) << k;
        if (mask == nullptr) continue;
        EXPECT_EQ(mask->runs(), expected[0].mask.runs()) << k;
        const Mask* seen = find_mask(visible, k);
        if (seen == nullptr) {
          ++hidden;
          continue;
        }
        EXPECT_TRUE(std::ranges::includes(pixels_of(*mask), pixels_of(*seen))) << k;
      }
      for (const ObjectMask& seen : visible) EXPECT_NE(find_mask(amodal, seen.object), nullptr);
    }
  }
  EXPECT_GT(hidden, 10U);
}

TEST(Masks, AmodalMasksDoNotDependOnThreadsOrStrips) {
  const Scene scene = adversarial_scene(7);
  const ImageSize size{.width = 2100, .height = 70};  // two strips
  const RenderedView view(scene, cameras()[0], size);
  const Masks one = view.amodal(1), three = view.amodal(3);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].object, three[k].object);
    EXPECT_EQ(one[k].mask.runs(), three[k].mask.runs());
  }
  const Masks visible = view.visible();
  ASSERT_FALSE(visible.empty());
  for (const ObjectMask& seen : visible) {
    const Mask* whole = find_mask(one, seen.object);
    ASSERT_NE(whole, nullptr);
    EXPECT_TRUE(std::ranges::includes(pixels_of(*whole), pixels_of(seen.mask)));
  }
}

TEST(Masks, ProgressGrowsAndCancels) {
  const Scene scene = adversarial_scene(1);
  const ImageSize size{.width = 1024, .height = 200};  // four strips
  const RenderedView rendered(scene, cameras()[0], size);
  double last = 0;
  QueryOptions options{.threads = 1};
  options.progress = [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return true;
  };
  static_cast<void>(amodal_masks(rendered.view(), options));
  EXPECT_EQ(last, 1);
  options.progress = [](double) { return false; };
  EXPECT_THROW(static_cast<void>(amodal_masks(rendered.view(), options)), Error);
}

}  // namespace
}  // namespace microtrace::dataset::tests
