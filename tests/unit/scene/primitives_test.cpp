#include <microtrace/primitives.hpp>

#include <cstddef>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// A scene with a mesh of each of these numbers of triangles; a sphere for the number 1.
Scene scene_of(std::span<const std::size_t> sizes) {
  Scene scene;
  for (const std::size_t size : sizes) {
    Object object;
    object.shape = Sphere{};
    if (size != 1) {
      Mesh mesh;
      mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
      mesh.triangles.assign(size, {0, 1, 2});
      object.shape = std::move(mesh);
    }
    scene.objects.push_back(std::move(object));
  }
  return scene;
}

void expect_all_found(std::span<const std::size_t> sizes) {
  const Scene scene = scene_of(sizes);
  const Primitives primitives(scene);
  PrimitiveId id = 0;
  for (std::size_t object = 0; object < sizes.size(); ++object) {
    ASSERT_EQ(primitives.first_id_of(object), id);
    for (std::size_t i = 0; i < sizes[object]; ++i, ++id) {
      ASSERT_EQ(primitives.object_index(id), object) << "primitive " << id;
      ASSERT_EQ(primitives.first_id(id), primitives.first_id_of(object));
    }
    ASSERT_EQ(primitives.end_id_of(object), id);
  }
  EXPECT_EQ(primitives.count(), id);
}

TEST(Primitives, FindsTheObjectOfEachPrimitive) {
  expect_all_found(std::vector<std::size_t>{1});
  expect_all_found(std::vector<std::size_t>{0, 0, 2, 0, 1, 1, 0, 36, 0});
  expect_all_found(std::vector<std::size_t>(3000, 1));
  // The table of ranges covers several primitives with each entry.
  expect_all_found(std::vector<std::size_t>{0, 5000, 1, 1, 1, 0, 3, 100000, 0, 0, 7});
  std::vector<std::size_t> small_and_large(5000, 1);
  small_and_large.push_back(200000);
  small_and_large.insert(small_and_large.end(), 5000, 2);
  expect_all_found(small_and_large);
}

TEST(Primitives, FindsTheObjectOfEachPrimitiveOfRandomScenes) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::size_t> sizes(1 + random() % 60);
    for (std::size_t& size : sizes) size = random() % 4 == 0 ? random() % 3000 : random() % 3;
    expect_all_found(sizes);
  }
}

TEST(Primitives, FindsTheObjectOfEachPrimitiveOfRuns) {
  Scene runs, single;
  std::size_t size = 1;
  for (const std::size_t count : {1U, 3U, 1U, 2000U}) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles.assign(size++, {0, 1, 2});
    std::vector<Placement> placements;
    for (std::size_t i = 0; i < count; ++i)
      placements.emplace_back(glm::translate(DMat4(1), DVec3(static_cast<double>(i), 0, 0)));
    runs.objects.push_back_run({.name = {}, .shape = mesh}, placements);
    runs.objects.push_back({.name = {}, .shape = Sphere{}});
  }
  single.objects = runs.objects.all();
  const Primitives primitives(runs), expected(single);
  ASSERT_EQ(primitives.count(), expected.count());
  for (PrimitiveId id = 0; id < primitives.count(); ++id) {
    const std::size_t object = expected.object_index(id);
    ASSERT_EQ(primitives.object_index(id), object);
    ASSERT_EQ(primitives.first_id(id), expected.first_id_of(object));
    ASSERT_EQ(primitives.first_id_of(object), expected.first_id_of(object));
    ASSERT_EQ(primitives.end_id_of(object), expected.end_id_of(object));
    const auto triangle = primitives.triangle(id), same = expected.triangle(id);
    ASSERT_EQ(triangle.has_value(), same.has_value());
    if (triangle) {
      ASSERT_EQ(triangle->a, same->a);
    }
  }
}

TEST(Primitives, CountsNoneInEmptyScenes) {
  const Scene empty;
  EXPECT_EQ(Primitives(empty).count(), 0U);
}

}  // namespace
}  // namespace microtrace
