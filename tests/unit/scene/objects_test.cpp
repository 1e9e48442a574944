#include <microtrace/error.hpp>
#include <microtrace/objects.hpp>

#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

Placement at(double x) {
  return Placement(glm::translate(DMat4(1), DVec3(x, 0, 0)));
}

Object named_triangle(ObjectName name) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return {.name = std::move(name), .shape = std::move(mesh), .material = 3};
}

/// A sphere, three instances of a triangle, and a sphere.
Objects with_run() {
  Objects objects;
  objects.push_back({.name = "first", .shape = Sphere{}});
  objects.push_back_run(named_triangle(ObjectName::numbered("tree[", "]")), {at(5), at(6), at(7)});
  objects.push_back({.name = "last", .shape = Sphere{}});
  return objects;
}

double x_of(const Object& object) {
  return std::get<Mesh>(object.shape).position(0).x;
}

TEST(Objects, RunsConsistOfMeshes) {
  Objects objects({{.name = "first", .shape = Sphere{}}});
  EXPECT_THROW(objects.push_back_run({.name = "ball", .shape = Sphere{}}, {at(1), at(2)}), Error);
  EXPECT_EQ(objects.size(), 1U);
  EXPECT_EQ(std::as_const(objects).all().size(), 1U);
}

TEST(Objects, AreChangedAtIteratorsOfConstOnes) {
  Objects objects = with_run();
  const Objects& read = objects;
  objects.insert(read.begin() + 2, Object{.name = "new", .shape = Sphere{}});
  EXPECT_EQ(read[2].name, "new");
  objects = with_run();
  objects.erase(read.begin() + 1, read.begin() + 3);
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[1].name, "tree[2]");
  objects = with_run();
  objects.erase(read.begin());
  EXPECT_EQ(read[0].name, "tree[0]");
}

TEST(Objects, OfRunsReadLikeSingleOnes) {
  const Objects objects = with_run();
  ASSERT_EQ(objects.size(), 5U);
  EXPECT_EQ(objects.runs().size(), 3U);
  const char* const names[] = {"first", "tree[0]", "tree[1]", "tree[2]", "last"};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(objects[i].name, names[i]);
    EXPECT_EQ(objects.name(i), names[i]);
    const ObjectRun run = objects.run(objects.run_of(i));
    EXPECT_LE(run.begin, i);
    EXPECT_LT(i, run.begin + run.count);
    EXPECT_EQ(static_cast<bool>(run.mesh(i - run.begin)), i >= 1 && i <= 3);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(x_of(objects[1 + i]), 5.0 + static_cast<double>(i));
    EXPECT_EQ(objects.run(1).mesh(i).position(0).x, 5.0F + static_cast<float>(i));
    EXPECT_EQ(objects[1 + i].material, 3U);
  }
}

TEST(Objects, CanBeChangedOneByOne) {
  Objects objects = with_run();
  const Objects before = objects;
  objects[2].name = "other";
  EXPECT_EQ(objects.runs().size(), 5U);
  EXPECT_EQ(objects.name(2), "other");
  EXPECT_EQ(x_of(objects[3]), 7);
  EXPECT_EQ(before.runs().size(), 3U);
  EXPECT_EQ(before[2].name, "tree[1]");
}

TEST(Objects, KeepTheirRunsWhenTheyAreAppended) {
  Objects single;
  single.push_back({.name = "zeroth", .shape = Sphere{}});
  Objects objects = single, more = with_run();
  objects.append(std::move(more));
  objects.append(with_run());
  objects.append(std::move(single));
  EXPECT_EQ(objects.runs().size(), 8U);
  ASSERT_EQ(objects.size(), 12U);
  EXPECT_EQ(objects.name(9), "tree[2]");
  EXPECT_EQ(x_of(std::as_const(objects)[9]), 7);
  EXPECT_EQ(objects.name(11), "zeroth");
}

TEST(Objects, OfARunGetAMaterialTogether) {
  Objects objects = with_run();
  EXPECT_EQ(std::as_const(objects)[2].material, 3U);
  objects.edit_runs([](Object& object) { object.material = 4; });
  EXPECT_EQ(objects.runs().size(), 3U);
  for (const Object& object : std::as_const(objects)) EXPECT_EQ(object.material, 4U);
}

}  // namespace
}  // namespace microtrace
