#include "support/cases/generated_meshes.hpp"

#include <microtrace/array.hpp>
#include <microtrace/error.hpp>
#include <microtrace/math.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/validate.hpp>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr std::array<float, 12> kNumbers{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
const std::vector<Vec3> kPoints{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}};

template <class T>
const void* address(const Array<T>& array) {
  return array.data();
}

TEST(ArrayTest, OwnsValuesLikeAVector) {
  Array<Vec3> a{{0, 1, 2}, {3, 4, 5}};
  const Array<Vec3> copy = a;
  a.push_back({6, 7, 8});
  a.emplace_back(9, 10, 11);
  EXPECT_EQ(a, kPoints);
  EXPECT_EQ(copy.size(), 2U);
  EXPECT_NE(copy, a);
  a.edit()[1].x = -3;
  EXPECT_EQ(a[1], Vec3(-3, 4, 5));
  EXPECT_EQ(copy.back(), Vec3(3, 4, 5));
  const Array<Vec3> moved = std::move(a);
  EXPECT_EQ(moved.size(), 4U);
  EXPECT_TRUE(a.empty());  // NOLINT(bugprone-use-after-move): empty, like a vector
  EXPECT_FALSE(moved.is_borrowed());
  EXPECT_TRUE(Array<Vec3>().empty());
  EXPECT_EQ(Array<Vec3>(), Array<Vec3>::borrow({}));
}

TEST(ArrayTest, BorrowsWithoutCopyingUntilItIsEdited) {
  std::vector<Vec3> points = kPoints;
  Array<Vec3> a = Array<Vec3>::borrow(points);
  Array<Vec3> copy = a;
  EXPECT_EQ(address(a), points.data());
  EXPECT_EQ(address(copy), points.data());
  copy.edit()[0].x = 7;
  EXPECT_EQ(points, kPoints);
  EXPECT_EQ(copy[0].x, 7);
  EXPECT_EQ(a, kPoints);
  Array<Vec3> moved = std::move(a);
  EXPECT_EQ(address(moved), points.data());
  EXPECT_TRUE(a.empty());  // NOLINT(bugprone-use-after-move): must not keep a dangling pointer
  moved.push_back(moved[0]);
  EXPECT_EQ(moved.size(), 5U);
  EXPECT_EQ(points.size(), 4U);
}

TEST(ArrayTest, KeepsTheOwnerOfItsMemoryAsLongAsItRefersToIt) {
  auto owner = std::make_shared<std::vector<Vec3>>(kPoints);
  const std::weak_ptr<std::vector<Vec3>> watched = owner;
  Array<Vec3> a = Array<Vec3>::borrow(*owner, owner);
  owner.reset();
  Array<Vec3> copy = a;
  a.clear();
  EXPECT_TRUE(a.empty());
  EXPECT_EQ(copy, kPoints);
  EXPECT_FALSE(watched.expired());
  copy.push_back(copy[0]);  // the argument lies in the memory that push_back releases
  EXPECT_TRUE(watched.expired());
  EXPECT_EQ(copy.back(), kPoints[0]);
}

TEST(ArrayTest, SharesValuesWithCopiesUntilOneIsEdited) {
  Array<Vec3> a = kPoints;
  const void* const there = address(a);
  Array<Vec3> copy = a;
  EXPECT_EQ(address(copy), there);
  a.edit()[0].x = 5;
  EXPECT_EQ(address(copy), there);
  EXPECT_EQ(copy, kPoints);
  EXPECT_EQ(a[0].x, 5);
  EXPECT_EQ(a[1], kPoints[1]);
  copy.edit()[0].x = 6;  // shared with none by now
  EXPECT_EQ(address(copy), there);
  EXPECT_EQ(a[0].x, 5);
  Array<Vec3> none;
  none.reserve(4);
  const Array<Vec3> also_none = none;
  none.push_back(kPoints[0]);
  EXPECT_EQ(none.size(), 1U);
  EXPECT_TRUE(also_none.empty());
}

TEST(ArrayTest, ThreadsEditCopiesOfTheirOwn) {
  const Array<Vec3> a = kPoints;
  std::vector<std::thread> threads;
  std::atomic<int> right = 0;
  for (int i = 1; i <= 4; ++i) {
    threads.emplace_back([copy = a, i, &right]() mutable {
      for (int round = 0; round < 1000; ++round) {
        const Array<Vec3> other = copy;
        copy.edit()[0].x = static_cast<float>(1000 * i + round);
        copy.push_back(other[0]);
        const float before = round == 0 ? 0 : static_cast<float>(1000 * i + round - 1);
        if (copy.back().x == before) ++right;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 4000);
  EXPECT_EQ(a, kPoints);
}

TEST(ArrayTest, UsesArraysOfTheRightLayoutInPlace) {
  const auto a = Array<Vec3>::strided(kNumbers.data(), 4);
  EXPECT_EQ(a, kPoints);
  EXPECT_EQ(address(a), kNumbers.data());
  const std::array<std::int32_t, 6> indices{2, 1, 0, -1, 5, 6};
  const auto corners = Array<Corners>::strided(indices.data(), 2, 12);
  EXPECT_EQ(address(corners), indices.data());
  EXPECT_EQ(corners[1][0], std::numeric_limits<std::uint32_t>::max());
  EXPECT_TRUE(Array<Vec3>::strided(kNumbers.data(), 0).empty());
  EXPECT_TRUE(Array<Vec3>::strided(static_cast<const float*>(nullptr), 0).empty());
}

TEST(ArrayTest, CopiesOtherLayouts) {
  const std::vector<Vec3> wide{{0, 1, 2}, {4, 5, 6}, {8, 9, 10}};
  EXPECT_EQ(Array<Vec3>::strided(kNumbers.data(), 3, 16), wide);
  const std::vector<Vec3> backwards{{9, 10, 11}, {6, 7, 8}, {3, 4, 5}};
  EXPECT_EQ(Array<Vec3>::strided(kNumbers.data() + 9, 3, -12), backwards);
  EXPECT_EQ(Array<Vec3>::strided(kNumbers.data(), 3, 0), std::vector<Vec3>(3, {0, 1, 2}));
  EXPECT_EQ(Array<Vec3>::strided(kNumbers.data(), 3, 4)[2], Vec3(2, 3, 4));
  std::array<unsigned char, sizeof kNumbers + 1> bytes{};
  std::memcpy(bytes.data() + 1, kNumbers.data(), sizeof kNumbers);
  const void* const unaligned = bytes.data() + 1;
  const auto a = Array<Vec3>::strided(static_cast<const float*>(unaligned), 4);
  EXPECT_EQ(a, kPoints);
  EXPECT_FALSE(a.is_borrowed());
}

TEST(ArrayTest, ConvertsNumbers) {
  const std::array<double, 3> doubles{0.1, 1e300, std::nan("")};
  const auto a = Array<Vec3>::strided(doubles.data(), 1);
  EXPECT_EQ(a[0].x, 0.1F);
  EXPECT_EQ(a[0].y, std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(a[0].z));
  const std::array<std::uint16_t, 7> shorts{9, 1, 2, 3, 65535, 5, 6};
  EXPECT_EQ(Array<Corners>::strided(shorts.data() + 1, 2),
            (std::vector<Corners>{{1, 2, 3}, {65535, 5, 6}}));
  const std::array<std::int64_t, 3> largest{0, 1, (std::int64_t{1} << 32) - 1};
  EXPECT_EQ(Array<Corners>::strided(largest.data(), 1)[0][2], 0xffffffffU);
  for (const std::int64_t wrong : {std::int64_t{-1}, std::int64_t{1} << 32}) {
    const std::array<std::int64_t, 3> indices{0, 1, wrong};
    EXPECT_THROW((void)Array<Corners>::strided(indices.data(), 1), Error) << wrong;
  }
  const std::array<std::int8_t, 3> negative{0, 1, -1};
  EXPECT_THROW((void)Array<Corners>::strided(negative.data(), 1), Error);
}

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = std::move(mesh)});
  return scene;
}

const Mesh& mesh_of(const PreparedScene& scene) {
  return std::get<Mesh>(scene.scene().objects[0].shape);
}

TEST(ArrayTest, ScenesFromBorrowedArraysHitLikeScenesThatOwnThem) {
  const Mesh own = generated::displaced_sphere(3000);
  const Mesh borrowed{.positions = Array<Vec3>::borrow(own.positions),
                      .triangles = Array<Corners>::borrow(own.triangles)};
  const PreparedScene first(scene_of(own)), second(scene_of(borrowed));
  EXPECT_EQ(address(mesh_of(second).positions), own.positions.data());
  EXPECT_EQ(address(mesh_of(second).triangles), own.triangles.data());
  for (int i = 0; i < 1000; ++i) {
    const auto x = static_cast<float>(i % 33) / 16 - 1, y = static_cast<float>(i % 31) / 15 - 1;
    const Ray ray{.o = {x, y, 5}, .d = {0.01F * y, 0.01F * x, -1}};
    const auto expected = first.intersect(ray), actual = second.intersect(ray);
    ASSERT_EQ(expected.has_value(), actual.has_value());
    if (expected) {
      EXPECT_EQ(expected->id, actual->id);
      EXPECT_EQ(expected->t, actual->t);
    }
  }
}

TEST(ArrayTest, WrongIndicesInBorrowedArraysAreErrors) {
  const std::array<std::int32_t, 6> indices{0, 1, 2, 0, -1, 3};
  const auto points = Array<Vec3>::strided(kNumbers.data(), 4);
  const Scene scene =
      scene_of({.positions = points, .triangles = Array<Corners>::strided(indices.data(), 2)});
  EXPECT_THROW(validate(scene), Error);
  EXPECT_THROW(PreparedScene{scene}, Error);
}

}  // namespace
}  // namespace microtrace
