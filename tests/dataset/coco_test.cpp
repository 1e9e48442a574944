#include "dataset/annotations/coco.hpp"

#include "views.hpp"

#include <microtrace/error.hpp>

#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace microtrace::dataset::tests {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

/// Decodes the compressed run lengths of a mask, as documented in pycocotools' maskApi.
std::set<Pixel> decoded(const std::string& text, std::uint32_t height) {
  std::vector<std::int64_t> counts;
  for (std::size_t p = 0; p < text.size();) {
    std::int64_t value = 0;
    int shift = 0;
    bool is_more = true;
    while (is_more) {
      const std::int64_t group = text.at(p++) - 48;
      value += (group & 31) * (std::int64_t{1} << shift);
      shift += 5;
      is_more = (group & 32) != 0;
      if (!is_more && (group & 16) != 0) value -= std::int64_t{1} << shift;
    }
    if (counts.size() > 2) value += counts[counts.size() - 2];
    counts.push_back(value);
  }
  std::set<Pixel> pixels;
  std::int64_t position = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    for (std::int64_t i = 0; i < counts[k]; ++i, ++position) {
      if (k % 2 == 1)
        pixels.emplace(static_cast<std::uint32_t>(position % height),
                       static_cast<std::uint32_t>(position / height));
    }
  }
  return pixels;
}

TEST(Coco, RandomMasksSurviveTheirEncoding) {
  std::mt19937 random(5);
  for (int round = 0; round < 500; ++round) {
    const ImageSize size{.width = static_cast<std::uint32_t>(1 + random() % 40),
                         .height = static_cast<std::uint32_t>(1 + random() % 40)};
    const auto density = static_cast<unsigned>(random() % 257);
    Mask mask;
    for (std::uint32_t y = 0; y < size.height; ++y) {
      for (std::uint32_t x = 0; x < size.width; ++x) {
        if (random() % 256 < density) mask.add(x, y);
      }
    }
    const std::vector<std::uint64_t> counts = column_counts(mask, size);
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}),
              std::uint64_t{size.width} * size.height);
    for (std::size_t k = 1; k < counts.size(); ++k) EXPECT_NE(counts[k], 0U);
    EXPECT_EQ(decoded(compressed_counts(counts), size.height), pixels_of(mask));
  }
}

TEST(Coco, CountsOfEdgeCases) {
  Mask corner, column;
  corner.add(0, 0);
  EXPECT_THAT(column_counts(corner, {.width = 1, .height = 1}), ElementsAre(0, 1));
  EXPECT_THAT(column_counts(corner, {.width = 3, .height = 2}), ElementsAre(0, 1, 5));
  EXPECT_THAT(column_counts(Mask(), {.width = 3, .height = 2}), ElementsAre(6));
  // The bottom of a column is followed by the top of the next one.
  column.add(1, 0);
  column.add(0, 1);
  EXPECT_THAT(column_counts(column, {.width = 3, .height = 2}), ElementsAre(1, 2, 3));
}

Scene overlapping_scene() {
  Scene scene;
  scene.materials = {Material{}, Material{}};
  scene.materials[0].name = "steel";
  scene.objects = {rectangle("nut", {-6, -3, 0}, 8, 4),
                   rectangle("bolt \"M4\"\n", {-1, -2, 1}, 5, 5),
                   rectangle("nut", {5, -2, 1}, 2, 2)};
  scene.objects[0].material = 0;
  scene.objects[2].material = 1;
  return scene;
}

constexpr ImageSize kCocoSize{.width = 16, .height = 10};

Json joined(const Categories& categories, const std::vector<std::string>& parts) {
  std::string text;
  join_coco(
      categories, parts.size(), [&](std::size_t i) { return parts[i]; },
      [&](std::string_view bytes) { text += bytes; });
  return Json::parse(text);
}

TEST(Coco, PartsAreJoinedWithRunningIds) {
  const Scene scene = overlapping_scene();
  Categories categories(CocoCategories::objects);
  categories.add(scene);
  const RenderedView first(scene, unit_camera(kCocoSize), kCocoSize, 3);
  const RenderedView empty(
      scene, OrthographicCamera{.pose = {.position = {0, 0, 20}, .direction = {0, 0, 1}}},
      kCocoSize, 4);
  const RenderedView second(scene, unit_camera(kCocoSize), kCocoSize, 9);
  std::vector<std::string> parts;
  for (const RenderedView* view : {&first, &empty, &second}) {
    const Masks amodal = view->amodal();
    parts.push_back(coco_part(view->view(), CocoCategories::objects, view->visible(), &amodal));
  }
  const Json json = joined(categories, parts);
  EXPECT_EQ(json["images"].size(), 3U);
  EXPECT_EQ(json["images"][2],
            (Json{{"id", 9}, {"width", 16}, {"height", 10}, {"file_name", "9.png"}}));
  EXPECT_EQ(json["categories"][0], (Json{{"id", 1}, {"name", "nut"}, {"supercategory", ""}}));
  EXPECT_EQ(json["categories"][1]["name"], "bolt \"M4\"\n");
  ASSERT_EQ(json["annotations"].size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(json["annotations"][k]["id"], k + 1);
  const Json& back = json["annotations"][3];
  EXPECT_EQ(back["image_id"], 9);
  EXPECT_EQ(back["category_id"], 1);
  EXPECT_EQ(back["iscrowd"], 0);
  EXPECT_EQ(back["area"], 8 * 4 - 3 * 3);
  EXPECT_EQ(back["bbox"], Json({2, 4, 8, 4}));
  EXPECT_EQ(back["segmentation"]["size"], Json({10, 16}));
  EXPECT_EQ(back["amodal_area"], 32);
  EXPECT_EQ(back["amodal_bbox"], Json({2, 4, 8, 4}));
  EXPECT_EQ(back["occlude_rate"], 9.0 / 32);
  EXPECT_EQ(decoded(back["segmentation"]["counts"], 10), pixels_of(second.visible()[0].mask));
  EXPECT_EQ(decoded(back["amodal_segmentation"]["counts"], 10).size(), 32U);
  EXPECT_EQ(json["annotations"][5]["occlude_rate"], 0);
}

TEST(Coco, CategoriesByMaterial) {
  const Scene scene = overlapping_scene();
  Categories categories(CocoCategories::materials);
  categories.add(scene);
  categories.add(scene);
  EXPECT_THAT(categories.names(), ElementsAre("steel", "unnamed"));
  EXPECT_EQ(categories.number_of(category_name(CocoCategories::materials, scene, scene.objects[0])),
            1U);
  EXPECT_EQ(categories.number_of(category_name(CocoCategories::materials, scene, scene.objects[1])),
            2U);
  EXPECT_EQ(categories.number_of(category_name(CocoCategories::materials, scene, scene.objects[2])),
            2U);
}

// Variants and animations change materials and visible objects.
TEST(Coco, ViewsMayShowDifferentScenes) {
  const Scene scene = overlapping_scene();
  Scene other = scene;
  std::swap(other.objects[0].name, other.objects[1].name);
  other.objects[2].name = "new";
  Categories categories(CocoCategories::objects);
  categories.add(scene);
  const RenderedView a(scene, unit_camera(kCocoSize), kCocoSize, 0);
  const RenderedView b(other, unit_camera(kCocoSize), kCocoSize, 1);
  const Json json = joined(categories, {coco_part(a.view(), CocoCategories::objects, a.visible()),
                                        coco_part(b.view(), CocoCategories::objects, b.visible())});
  ASSERT_EQ(json["annotations"].size(), 6U);
  for (const Json& annotation : json["annotations"]) {
    const std::size_t category = annotation["category_id"].get<std::size_t>();
    EXPECT_EQ(json["categories"][category - 1]["name"], annotation["object_name"]);
  }
  ASSERT_EQ(json["categories"].size(), 3U);
  EXPECT_EQ(json["categories"][2]["name"], "new");
}

TEST(Coco, EmptyDataSetsAndIncompleteParts) {
  const Categories categories(CocoCategories::objects);
  const Json json = joined(categories, {});
  EXPECT_EQ(json["images"], Json::array());
  EXPECT_EQ(json["annotations"], Json::array());
  EXPECT_EQ(json["categories"], Json::array());
  const Scene scene = overlapping_scene();
  Categories known(CocoCategories::objects);
  known.add(scene);
  const RenderedView view(scene, unit_camera(kCocoSize), kCocoSize);
  const std::string part = coco_part(view.view(), CocoCategories::objects, view.visible());
  EXPECT_EQ(joined(known, {part})["annotations"].size(), 3U);
  for (std::size_t size = 0; size < part.size(); ++size)
    EXPECT_THROW(static_cast<void>(joined(known, {part.substr(0, size)})), Error) << size;
}

}  // namespace
}  // namespace microtrace::dataset::tests
