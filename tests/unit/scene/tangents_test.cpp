#include "scene/mesh/tangents.hpp"

#include "scene/mesh/tangent_groups.hpp"
#include "support/pi.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

namespace microtrace {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Functions that give the position, normal and texture coordinates at each (x, y) of [0, 1]^2.
struct Sheet {
  std::function<Vec3(double, double)> position, normal;
  std::function<Vec2(double, double)> uv;
};

/// Returns a grid of 2 * columns * rows triangles. Seen from the front, x points right and y points
/// up.
Mesh grid(const Sheet& sheet, std::uint32_t columns, std::uint32_t rows) {
  Mesh mesh;
  mesh.uv_sets.resize(1);
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double x = static_cast<double>(i) / columns, y = static_cast<double>(j) / rows;
      mesh.positions.push_back(sheet.position(x, y));
      mesh.normals.push_back(sheet.normal(x, y));
      mesh.uv_sets[0].push_back(sheet.uv(x, y));
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

const Sheet kPlane{.position = [](double x, double y) { return Vec3(x, y, 0); },
                   .normal = [](double, double) { return Vec3(0, 0, 1); },
                   .uv = [](double x, double y) { return Vec2(x, 1 - y); }};

Sheet with_uv(Sheet sheet, std::function<Vec2(double, double)> uv) {
  sheet.uv = std::move(uv);
  return sheet;
}

/// Returns the generated tangents of the mesh's vertices.
Array<Vec4> tangents_of(Mesh mesh) {
  make_tangents(mesh, 0);
  return mesh.tangents;
}

void expect_near(const Vec4& actual, const Vec4& wanted, float tolerance = 1e-6F) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(actual[i], wanted[i], tolerance) << "at " << i;
}

TEST(Tangents, FollowUWithTheBitangentUp) {
  Mesh mesh = grid(kPlane, 4, 3);
  const std::vector<std::uint32_t> origin = make_tangents(mesh, 0);
  std::vector<std::uint32_t> all(mesh.positions.size());
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(origin, all) << "nothing to split";
  ASSERT_EQ(mesh.tangents.size(), 20U);
  for (const Vec4& t : mesh.tangents) expect_near(t, {1, 0, 0, 1});
}

TEST(Tangents, MirroredCoordinatesFlipTheHandedness) {
  const auto mirrored = [](double x, double y) { return Vec2(-x, 1 - y); };
  for (const Vec4& t : tangents_of(grid(with_uv(kPlane, mirrored), 2, 2))) {
    expect_near(t, {-1, 0, 0, -1});
  }
}

TEST(Tangents, ShearedCoordinatesGiveTheDerivativeByU) {
  // With u = x + y / 2 and v = -2 y, u increases along x where v is constant.
  const auto sheared = [](double x, double y) { return Vec2(x + y / 2, -2 * y); };
  for (const Vec4& t : tangents_of(grid(with_uv(kPlane, sheared), 3, 3))) {
    expect_near(t, {1, 0, 0, 1});
  }
  // Swaps u and v: a reflection about the diagonal.
  const auto swapped = [](double x, double y) { return Vec2(y, x); };
  for (const Vec4& t : tangents_of(grid(with_uv(kPlane, swapped), 3, 3))) {
    expect_near(t, {0, 1, 0, 1});
  }
}

TEST(Tangents, PointEastOnASphere) {
  const auto on_sphere = [](double x, double y) {
    const double longitude = 2 * kPi * x, latitude = kPi * (0.8 * y - 0.4);
    return Vec3(std::cos(longitude) * std::cos(latitude), std::sin(latitude),
                -std::sin(longitude) * std::cos(latitude));
  };
  const Sheet sphere{.position = on_sphere, .normal = on_sphere, .uv = kPlane.uv};
  constexpr std::uint32_t columns = 64;
  const Array<Vec4> tangents = tangents_of(grid(sphere, columns, 32));
  for (std::uint32_t i = 0; i < tangents.size(); ++i) {
    const std::uint32_t column = i % (columns + 1);
    if (column == 0 || column == columns) continue;  // the seam has neighbors only on one side
    const double longitude = 2 * kPi * column / columns;
    expect_near(tangents[i], {-std::sin(longitude), 0, -std::cos(longitude), 1}, 2e-3F);
  }
}

TEST(Tangents, WeightTrianglesByAngle) {
  // Two triangles share an edge. At vertex 0 the first one has an angle of 90 degrees, the second
  // one of 45 degrees.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  // u increases along x in the first triangle and along -x in the second one.
  mesh.uv_sets = {{{0, 0}, {1, 0}, {0, -1}, {1, -1}}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<Vec4> corners = corner_tangents({.positions = mesh.positions,
                                                     .normals = mesh.normals,
                                                     .uv = mesh.uv_sets[0],
                                                     .triangles = mesh.triangles});
  // The second triangle is mirrored, so the two don't share tangents.
  expect_near(corners[0], {1, 0, 0, 1});
  expect_near(corners[3], {-1, 0, 0, -1});
  mesh.uv_sets = {{{0, 0}, {1, 0}, {0, -1}, {-1, -2}}};
  const std::vector<Vec4> shared = corner_tangents({.positions = mesh.positions,
                                                    .normals = mesh.normals,
                                                    .uv = mesh.uv_sets[0],
                                                    .triangles = mesh.triangles});
  // For the second triangle, let e and f be the columns of d p / d (u, v). They satisfy -f = (0, 1)
  // and -e - 2 f = (-1, 1), so e = (1, 1) and f = (0, -1).
  const double half = std::sqrt(0.5);
  const DVec3 sum = (kPi / 2) * DVec3(1, 0, 0) + (kPi / 4) * DVec3(half, half, 0);
  expect_near(shared[0], Vec4(Vec3(sum / std::sqrt(glm::dot(sum, sum))), 1));
  EXPECT_EQ(shared[0], shared[3]);
  expect_near(shared[1], {1, 0, 0, 1});
  expect_near(shared[5], {half, half, 0, 1});
}

TEST(Tangents, SplitVerticesBetweenMirroredTriangles) {
  const auto folded = [](double x, double y) { return Vec2(std::abs(x - 0.5), 1 - y); };
  Mesh mesh = grid(with_uv(kPlane, folded), 2, 1);
  mesh.colors.assign(6, Vec4(1));
  mesh.colors.edit()[1] = Vec4(0.5F);
  mesh.segments = {{1, 4}};
  const Mesh before = mesh;
  const std::vector<std::uint32_t> origin = make_tangents(mesh, 0);
  EXPECT_THAT(origin, ElementsAre(0, 1, 1, 2, 3, 4, 4, 5));
  ASSERT_EQ(mesh.tangents.size(), 8U);
  ASSERT_EQ(mesh.positions.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(mesh.positions[i], before.positions[origin[i]]);
    EXPECT_EQ(mesh.normals[i], before.normals[origin[i]]);
    EXPECT_EQ(mesh.uv_sets[0][i], before.uv_sets[0][origin[i]]);
    EXPECT_EQ(mesh.colors[i], before.colors[origin[i]]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool left = t == 0 || t == 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[t][k];
      EXPECT_EQ(origin[vertex], before.triangles[t][k]);
      expect_near(mesh.tangents[vertex], left ? Vec4(-1, 0, 0, -1) : Vec4(1, 0, 0, 1));
    }
  }
  EXPECT_EQ(origin[mesh.segments[0][0]], 1U);
  EXPECT_EQ(origin[mesh.segments[0][1]], 4U);
}

TEST(Tangents, TrianglesWithoutTextureAreaUseTheirNeighbors) {
  Mesh mesh = grid(kPlane, 2, 1);
  // The right half maps to a line in the image, so its left vertices take the tangents of the left
  // half.
  for (const std::size_t i : {1U, 2U, 4U, 5U}) mesh.uv_sets[0].edit()[i].x = 0.5F;
  const Array<Vec4> tangents = tangents_of(mesh);
  ASSERT_EQ(tangents.size(), 6U);
  for (const std::size_t i : {0U, 1U, 3U, 4U}) expect_near(tangents[i], {1, 0, 0, 1});
}

TEST(Tangents, WithoutTextureAreaAnyPerpendicularDirectionIsValid) {
  std::mt19937 random(7);
  std::normal_distribution<double> coordinate;
  for (int round = 0; round < 100; ++round) {
    const DVec3 v(coordinate(random), coordinate(random), coordinate(random));
    const Vec3 n(v / std::sqrt(glm::dot(v, v)));
    Mesh mesh = grid({.position = kPlane.position,
                      .normal = [&](double, double) { return n; },
                      .uv = [](double, double) { return Vec2(0.5F); }},
                     1, 1);
    for (const Vec4& t : tangents_of(mesh)) {
      EXPECT_NEAR(glm::dot(Vec3(t), n), 0, 1e-6);
      EXPECT_NEAR(glm::dot(Vec3(t), Vec3(t)), 1, 1e-6);
      EXPECT_EQ(t.w, 1);
    }
  }
}

TEST(Tangents, TrianglesWithoutAreaUseTheirVertices) {
  Mesh mesh = grid(kPlane, 1, 1);
  std::vector<std::array<std::uint32_t, 3>>& triangles = mesh.triangles.edit();
  triangles.insert(triangles.begin(), {1, 1, 3});
  const Array<Vec4> tangents = tangents_of(mesh);
  ASSERT_EQ(tangents.size(), 4U);
  for (const Vec4& t : tangents) expect_near(t, {1, 0, 0, 1});
}

TEST(Tangents, OppositeDirectionsAroundAVertexDoNotCancel) {
  // Four triangles share a vertex and have equal v there. Their u increases around the vertex.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {1, 0, 0}};
  mesh.normals.assign(6, {0, 0, 1});
  mesh.uv_sets = {{{0.5, 0}, {0, 1}, {0.25, 1}, {0.5, 1}, {0.75, 1}, {1, 1}}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  for (const Vec4& t : tangents_of(mesh)) {
    EXPECT_NEAR(glm::dot(Vec3(t), Vec3(t)), 1, 1e-6);
    EXPECT_EQ(t.z, 0);
  }
}

TEST(Tangents, WithoutNormalsTrianglesAreFlat) {
  // A roof of two 45-degree slopes that meet in a ridge along the y axis.
  Mesh mesh;
  mesh.positions = {{-1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 1}, {1, 1, 0}};
  mesh.uv_sets = {{{0, 1}, {0.5, 1}, {1, 1}, {0, 0}, {0.5, 0}, {1, 0}}};
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  const std::vector<std::uint32_t> origin = make_tangents(mesh, 0);
  EXPECT_THAT(mesh.normals, IsEmpty());
  EXPECT_EQ(mesh.positions.size(), 8U) << "the ridge is split";
  const float half = std::sqrt(0.5F);
  for (std::size_t t = 0; t < 4; ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) {
      expect_near(mesh.tangents[vertex], {half, 0, t < 2 ? half : -half, 1});
    }
  }
}

/// Returns the tangents of a bumpy sheet with a fold, by corner of the triangles in their original
/// order.
std::vector<Vec4> shuffled_corners(std::uint32_t seed) {
  const Sheet sheet{
      .position = [](double x, double y) { return Vec3(x, y, 0.1 * std::sin(9 * x) * y); },
      .normal =
          [](double x, double y) {
            const Vec3 n(-0.9 * std::cos(9 * x) * y, -0.1 * std::sin(9 * x), 1);
            return n / std::sqrt(glm::dot(n, n));
          },
      .uv = [](double x, double y) { return Vec2(std::abs(x - 0.5) + y * y, y); }};
  const Mesh mesh = grid(sheet, 16, 16);
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::mt19937 random(seed);
  if (seed != 0) std::ranges::shuffle(order, random);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const std::uint32_t i : order) {
    auto corners = mesh.triangles[i];
    std::ranges::rotate(corners, corners.begin() + i % 3 * (seed != 0));
    triangles.push_back(corners);
  }
  const std::vector<Vec4> tangents = corner_tangents({.positions = mesh.positions,
                                                      .normals = mesh.normals,
                                                      .uv = mesh.uv_sets[0],
                                                      .triangles = triangles});
  std::vector<Vec4> result(tangents.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t own = (k + order[i] % 3 * (seed != 0)) % 3;
      result[3 * order[i] + own] = tangents[3 * i + k];
    }
  }
  return result;
}

TEST(Tangents, OrderOfTrianglesHasNoEffect) {
  const std::vector<Vec4> wanted = shuffled_corners(0);
  for (std::uint32_t seed = 1; seed < 5; ++seed) {
    const std::vector<Vec4> actual = shuffled_corners(seed);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      ASSERT_NEAR(glm::distance(actual[i], wanted[i]), 0, 1e-5) << seed << " " << i;
    }
  }
}

TEST(Tangents, IndexingHasNoEffect) {
  const auto wavy = [](double x, double y) { return Vec2(x + 0.3 * y * y, 1 - y); };
  const Mesh mesh = grid(with_uv(kPlane, wavy), 5, 5);
  Mesh apart;
  apart.uv_sets.resize(1);
  for (const auto& triangle : mesh.triangles) {
    const auto number = static_cast<std::uint32_t>(apart.positions.size());
    apart.triangles.push_back({number, number + 1, number + 2});
    for (const std::uint32_t vertex : triangle) {
      apart.positions.push_back(mesh.positions[vertex]);
      apart.normals.push_back(mesh.normals[vertex]);
      apart.uv_sets[0].push_back(mesh.uv_sets[0][vertex]);
    }
  }
  const Array<Vec4> wanted = tangents_of(mesh), actual = tangents_of(apart);
  ASSERT_EQ(actual.size(), 3 * mesh.triangles.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_EQ(actual[i], wanted[mesh.triangles[i / 3][i % 3]]);
  }
}

// Quadratic time would be minutes.
TEST(Tangents, FanOfManyTriangles) {
  Mesh mesh;
  constexpr std::uint32_t count = 200'000;
  mesh.positions.push_back({0, 0, 1});
  mesh.uv_sets = {{{0, 0}}};
  for (std::uint32_t i = 0; i <= count; ++i) {
    const double angle = kPi * i / count;
    mesh.positions.push_back({std::cos(angle), std::sin(angle), 0});
    mesh.uv_sets[0].push_back({std::cos(angle), -std::sin(angle)});
  }
  mesh.normals.assign(count + 2, {0, 0, 1});
  for (std::uint32_t i = 1; i <= count; ++i) mesh.triangles.push_back({0, i, i + 1});
  const Array<Vec4> tangents = tangents_of(mesh);
  expect_near(tangents[0], {1, 0, 0, 1}, 1e-3F);
}

}  // namespace
}  // namespace microtrace
