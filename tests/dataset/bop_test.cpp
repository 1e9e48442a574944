#include "dataset/annotations/bop.hpp"

#include "dataset/annotations/bop_models.hpp"
#include "io/image/decode/decode_image.hpp"
#include "views.hpp"

#include <microtrace/error.hpp>

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace microtrace::dataset::tests {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

constexpr ImageSize kBopSize{.width = 16, .height = 10};

/// Returns one pixel per 0.1 units at depth 1.
Camera pinhole() {
  return CalibratedCamera{.pose = {.position = {0, 0, 10}},
                          .image = kBopSize,
                          .fx = 10,
                          .fy = 10,
                          .cx = 7.5,
                          .cy = 4.5};
}

Scene two_rectangles() {
  Scene scene;
  scene.origin = {100, 200, 300};
  scene.objects = {rectangle("back", {-6, -3, 0}, 8, 4), rectangle("front", {-1, -2, 0}, 5, 5),
                   rectangle("hidden", {0, 0, -1}, 1, 1), rectangle("outside", {90, 90, 0}, 1, 1)};
  return scene;
}

BopAnnotations bop_of(const RenderedView& view, const Scene& scene,
                      const BopOptions& options = {}) {
  return bop_view(view.view(), BopFrames(scene), view.visible(), view.amodal(), options);
}

Json joined(BopFile file, const std::vector<std::string>& parts) {
  std::string text;
  join_bop(
      file, parts.size(), [&](std::size_t i) { return parts[i]; },
      [&](std::string_view bytes) { text += bytes; });
  return Json::parse(text);
}

const std::string& bytes_of(const BopAnnotations& view, std::string_view name) {
  for (const NamedFile& file : view.files) {
    if (file.name == name) return file.bytes;
  }
  throw std::out_of_range(std::string(name));
}

template <class Sample>
std::vector<Sample> samples_of(const std::string& png) {
  const io::DecodedImage read = io::decode_image(png);
  return std::get<std::vector<Sample>>(read.image.value().samples);
}

TEST(Bop, CameraPosesAndCountsInClosedForm) {
  const Scene scene = two_rectangles();
  const RenderedView view(scene, pinhole(), kBopSize, 7);
  const BopAnnotations bop = bop_of(view, scene, {.depth_scale = 0.25});
  const Json camera = joined(BopFile::scene_camera, {bop.part})["7"];
  EXPECT_EQ(camera["cam_K"], Json({10, 0, 7.5, 0, 10, 4.5, 0, 0, 1}));
  EXPECT_EQ(camera["cam_R_w2c"], Json({1, 0, 0, 0, -1, 0, 0, 0, -1}));
  // The camera is at (100, 200, 310) in world space.
  EXPECT_EQ(camera["cam_t_w2c"], Json({-100e3, 200e3, 310e3}));
  EXPECT_EQ(camera["depth_scale"], 0.25);
  const Json gt = joined(BopFile::scene_gt, {bop.part})["7"];
  ASSERT_EQ(gt.size(), 3U);
  EXPECT_EQ(gt[0]["obj_id"], 1);
  EXPECT_EQ(gt[0]["cam_t_m2c"], Json({-2000, 1000, 10000}));  // of the center (-2, -1, 0)
  EXPECT_EQ(gt[2]["obj_id"], 3);
  // At depth 10, a unit is a pixel.
  const Json info = joined(BopFile::scene_gt_info, {bop.part})["7"];
  EXPECT_EQ(info[0]["px_count_all"], 32);
  EXPECT_EQ(info[0]["px_count_visib"].get<int>() + info[1]["px_count_visib"].get<int>(),
            32 + 25 - 3 * 3);
  EXPECT_EQ(info[0]["px_count_valid"], 32);
  EXPECT_EQ(info[0]["visib_fract"], info[0]["px_count_visib"].get<double>() / 32);
  EXPECT_EQ(info[0]["bbox_obj"], Json({2, 4, 7, 3}));
  EXPECT_EQ(info[2]["px_count_visib"], 0);
  EXPECT_EQ(info[2]["bbox_obj"], Json({-1, -1, -1, -1}));
  EXPECT_EQ(info[2]["bbox_visib"], Json({-1, -1, -1, -1}));
  EXPECT_EQ(info[2]["visib_fract"], 0);

  const auto depth = samples_of<std::uint16_t>(bytes_of(bop, "depth/000007.png"));
  const DrawnView drawn = view.view();
  for (std::size_t i = 0; i < depth.size(); ++i)
    EXPECT_EQ(depth[i], drawn.objects[i] == kNoObject ? 0 : 40000);
  const auto mask = samples_of<std::uint8_t>(bytes_of(bop, "mask/000007_000002.png"));
  EXPECT_EQ(std::ranges::count(mask, 255), info[2]["px_count_all"].get<int>());
  const auto hidden = samples_of<std::uint8_t>(bytes_of(bop, "mask_visib/000007_000002.png"));
  EXPECT_EQ(std::ranges::count(hidden, 0), 160);
  EXPECT_FALSE(bop.too_far || bop.too_near);
}

TEST(Bop, FarDepthsAreStoredAsZeroWithAWarning) {
  const Scene scene = two_rectangles();
  const RenderedView view(scene, pinhole(), kBopSize);
  const BopAnnotations bop = bop_of(view, scene);  // 100000 steps
  EXPECT_FALSE(bop.too_near);
  ASSERT_TRUE(bop.too_far);
  EXPECT_THAT(bop.too_far->message,
              testing::HasSubstr("view 0 stores 48 depths beyond 65535 steps"));
  EXPECT_EQ(std::ranges::count(samples_of<std::uint16_t>(bytes_of(bop, "depth/000000.png")), 0),
            160);
  EXPECT_EQ(joined(BopFile::scene_gt_info, {bop.part})["0"][0]["px_count_valid"], 0);
}

TEST(Bop, FarAndNearDepthsAreBothNamed) {
  Scene scene = two_rectangles();
  scene.objects.push_back(rectangle("near", {-4e-5F, -3e-5F, 9.99995F}, 4e-5F, 6e-5F));
  const RenderedView view(scene, pinhole(), kBopSize);
  const BopAnnotations bop = bop_of(view, scene, {.depth_scale = 0.12});
  ASSERT_TRUE(bop.too_far && bop.too_near);
  EXPECT_THAT(bop.too_far->message, testing::HasSubstr("no depth scale suits"));
  EXPECT_THAT(bop.too_near->message, testing::HasSubstr("below half a step"));
}

TEST(Bop, OtherCamerasAndScalesAreRefused) {
  const Scene scene = two_rectangles();
  auto distorted = std::get<CalibratedCamera>(pinhole()), fisheye = distorted;
  distorted.distortion = RationalDistortion{.k1 = 0.1};
  fisheye.distortion = FisheyeDistortion{};
  for (const Camera& camera :
       {unit_camera(kBopSize), Camera(EnvironmentCamera{}), Camera(distorted), Camera(fisheye)})
    EXPECT_THROW(static_cast<void>(bop_of(RenderedView(scene, camera, kBopSize), scene)), Error);
  const RenderedView view(scene, pinhole(), kBopSize);
  for (const double scale : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    EXPECT_THROW(static_cast<void>(bop_of(view, scene, {.depth_scale = scale})), Error);
    EXPECT_THROW(static_cast<void>(bop_of(view, scene, {.millimeters_per_unit = scale})), Error);
  }
}

TEST(Bop, EmptyViewsAndIncompleteParts) {
  const RenderedView view(Scene{}, PerspectiveCamera{}, {.width = 1, .height = 1}, 1234567);
  const BopAnnotations bop = bop_of(view, Scene{});
  EXPECT_EQ(joined(BopFile::scene_gt, {bop.part}), (Json{{"1234567", Json::array()}}));
  EXPECT_EQ(bop.files.size(), 1U);
  EXPECT_EQ(joined(BopFile::scene_gt, {}), Json::object());
  for (std::size_t size = 0; size < bop.part.size(); ++size)
    EXPECT_THROW(static_cast<void>(joined(BopFile::scene_gt, {bop.part.substr(0, size)})), Error);
}

TEST(Bop, ModelIsCenteredAndInMillimeters) {
  Scene scene = two_rectangles();
  scene.objects.push_back({.name = "ball", .shape = Sphere{}});
  scene.objects.push_back(
      {.name = "t", .shape = Triangle{.a = {0, 0, 0}, .b = {3, 0, 0}, .c = {0, 4, 0}}});
  const BopFrames frames(scene);
  const auto model = bop_model(scene, 0, frames, {.first_object_id = 41});
  ASSERT_TRUE(model);
  EXPECT_EQ(model->id, 41U);
  EXPECT_EQ(model->file.name, "models/obj_000041.ply");
  EXPECT_FALSE(bop_model(scene, 4, frames));
  const auto triangle = bop_model(scene, 5, frames);
  ASSERT_TRUE(triangle);
  const Json info = Json::parse(bop_models_info(std::vector{*triangle, *model}));
  EXPECT_EQ(info["41"], (Json{{"diameter", std::sqrt(80e6)},
                              {"min_x", -4000},
                              {"min_y", -2000},
                              {"min_z", 0},
                              {"size_x", 8000},
                              {"size_y", 4000},
                              {"size_z", 0}}));
  EXPECT_EQ(info["6"]["diameter"], 5000);
}

TEST(Bop, DiameterEqualsThatOfAllPairs) {
  std::mt19937 random(3);
  const auto number = [&] { return static_cast<double>(random() % 4096) - 2048; };
  for (int round = 0; round < 60; ++round) {
    std::vector<DVec3> points;
    const std::size_t count = round < 4 ? static_cast<std::size_t>(round) : 1 + random() % 700;
    for (std::size_t i = 0; i < count; ++i) {
      DVec3 p(number(), number(), round % 5 == 1 ? 0 : number());
      if (round % 3 == 0) p *= 2048 / std::max(1.0, std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
      points.push_back(round % 7 == 2 ? DVec3(1, 2, 3) : p);
    }
    double most = 0;
    for (const DVec3& a : points) {
      for (const DVec3& b : points) {
        const DVec3 way = a - b;
        most = std::max(most, std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z));
      }
    }
    EXPECT_EQ(diameter(points), most);
  }
}

}  // namespace
}  // namespace microtrace::dataset::tests
