#include "scene/kernels/dispatch.hpp"
#include "scene/surface/surface_finder.hpp"
#include "support/cases/adversarial_scenes.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/surface_interaction.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

std::uint32_t bits(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

void expect_surface(const SurfaceBatch& batch, std::size_t i, const SurfaceInteraction& at) {
  for (glm::length_t k = 0; k < 3; ++k) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(batch.p[k][i]), std::bit_cast<std::uint64_t>(at.p[k]));
    ASSERT_EQ(bits(batch.n[k][i]), bits(at.n[k]));
    ASSERT_EQ(bits(batch.ns[k][i]), bits(at.ns[k]));
    ASSERT_EQ(bits(batch.barycentrics[k][i]), bits(at.triangle ? at.triangle->barycentrics[k] : 0));
  }
  const DVec2 uv = at.uv(0).value_or(DVec2(0));
  ASSERT_EQ(bits(batch.uv[0][i]), bits(uv.x));
  ASSERT_EQ(bits(batch.uv[1][i]), bits(uv.y));
  ASSERT_EQ(batch.side[i], at.front ? 1 : -1);
  ASSERT_EQ(batch.object[i], at.object);
  ASSERT_EQ(batch.primitive[i], at.primitive);
}

TEST(SceneKernels, FindTheSurfacesOfSingleHits) {
  adversarial::Random random(5);
  for (const adversarial::SceneKind kind : adversarial::kSceneKinds) {
    if (kind == adversarial::SceneKind::any_size) continue;  // contains numbers that are not finite
    SCOPED_TRACE(adversarial::name(kind));
    Scene scene = adversarial::random_scene(random, kind);
    for (Object& object : scene.objects) {
      auto* mesh = std::get_if<Mesh>(&object.shape);
      if (mesh == nullptr || random.one_in(4)) continue;
      mesh->uv_sets.emplace_back();
      for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
        mesh->normals.push_back(random.one_in(8) ? Vec3(0) : random.in_cube(1));
        mesh->uv_sets[0].push_back(Vec2(random.in_cube(1)));
      }
    }
    const Bvh bvh(scene, {.threads = 1});
    const SurfaceFinder finder(bvh.primitives());
    const std::vector<Ray> rays = adversarial::unrelated_rays(random, scene, 3000);
    std::vector<std::optional<Hit>> hits(rays.size());
    bvh.intersect(rays, hits);
    for (const SceneKernels* kernels : kSceneKernels.available()) {
      SCOPED_TRACE(kernels->name);
      std::size_t count = 0, found = 0;
      for (std::size_t first = 0; first < rays.size(); first += count) {
        count = std::min<std::size_t>(1 + first % kSurfaceLanes, rays.size() - first);
        const auto own = std::span(hits).subspan(first, count);
        SurfaceBatch batch;
        finder.find(std::span(rays).subspan(first, count), own, {.n = true, .ns = true, .uv = true},
                    batch, *kernels);
        for (std::size_t i = 0; i < count; ++i) {
          if (!own[i]) continue;
          ++found;
          expect_surface(batch, i, interact(bvh.primitives(), rays[first + i], *own[i]));
        }
      }
      EXPECT_GT(found, 100U);
    }
  }
}

void expect_ray(const Ray& a, const Ray& b) {
  for (glm::length_t k = 0; k < 3; ++k) {
    ASSERT_EQ(bits(a.o[k]), bits(b.o[k]));
    ASSERT_EQ(bits(a.d[k]), bits(b.d[k]));
  }
  ASSERT_EQ(bits(a.t_min), bits(b.t_min));
  ASSERT_EQ(bits(a.t_max), bits(b.t_max));
}

TEST(SceneKernels, MakeTheRaysOfSinglePixels) {
  std::mt19937 engine(7);
  const auto number = [&] { return static_cast<double>(engine()) / 0x1p31 - 1; };
  for (int round = 0; round < 200; ++round) {
    const bool is_aligned = round % 4 == 0;  // gives zeros of both signs
    const DepthRange depth =
        round % 3 == 0 ? DepthRange{} : DepthRange{.near = 1 + number(), .far = 3 + number()};
    const PerspectiveCamera camera{
        .pose = {.position = {number(), number(), number()},
                 .direction = is_aligned ? DVec3(0, 0, -1) : DVec3(number(), number(), -1),
                 .up = {0, 1, 0}},
        .vertical_fov = 1.5 + number(),
        .depth = depth};
    const RayGenerator rays(camera, {.width = 40, .height = 31});
    const Ray guard{.o = Vec3(77)};
    for (std::uint32_t count = 0; count < 20; ++count) {
      std::vector<Ray> row(count + 1, guard);
      const std::uint32_t x = count % 3, y = static_cast<std::uint32_t>(round) % 31;
      rays.centers(x, y, std::span(row).first(count));
      for (std::uint32_t i = 0; i < count; ++i) expect_ray(row[i], rays(x + i + 0.5, y + 0.5));
      expect_ray(row[count], guard);
    }
  }
}

TEST(SceneKernels, MakeTheSameRays) {
  const PerspectiveRays camera{.corner = {-0.5, 0.25, -1},
                               .right = {0.0625, -0.0, 0},
                               .down = {-0.0, -0.1, 0},
                               .origin = {1, 2, 3},
                               .least_t_min = 0.11F,
                               .near = 0.1,
                               .far = 10};
  for (const SceneKernels* kernels : kSceneKernels.available()) {
    for (const std::size_t count : {0, 1, 2, 3, 7, 8, 9, 33, 64}) {
      std::vector<Ray> rays(count), expected(count);
      std::vector<double> x(count), y(count);
      for (std::size_t i = 0; i < count; ++i) {
        x[i] = 0.37 * static_cast<double>(i) - 2;
        y[i] = 2.5 - static_cast<double>(i * i % 11);
      }
      kernels->perspective_rays(camera, x.data(), y.data(), rays.data(), count);
      kPortableScene.perspective_rays(camera, x.data(), y.data(), expected.data(), count);
      for (std::size_t i = 0; i < count; ++i) {
        expect_ray(rays[i], expected[i]);
        EXPECT_GE(rays[i].t_min, camera.least_t_min);
      }
    }
  }
}

// Sixteen rays at a time, and one by one.
TEST(SceneKernels, FindTheSpacingsOfRows) {
  const Pose pose{.position = {1, 2, 3}, .direction = {0.3, 0.1, -1}};
  for (const Camera& camera :
       {Camera(PerspectiveCamera{.pose = pose}), Camera(OrthographicCamera{.pose = pose}),
        Camera(EnvironmentCamera{.pose = pose}),
        Camera(CalibratedCamera{.pose = pose, .distortion = FisheyeDistortion{.k1 = 0.1}})}) {
    const RayGenerator rays(camera, {.width = 40, .height = 31});
    std::array<float, 16> x, y, z;
    std::vector<Ray> row(16);
    rays.centers(5, 7, row);
    for (std::size_t i = 0; i < row.size(); ++i)
      x[i] = row[i].d.x, y[i] = row[i].d.y, z[i] = row[i].d.z;
    std::array<RayGenerator::RowSpacing, 16> spacings;
    rays.row_spacings({x.data(), y.data(), z.data()}, spacings);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const RayDifferential step = rays.differential(row[i]);
      EXPECT_EQ(spacings[i].begin, glm::length(step.o_dy));
      EXPECT_NEAR(spacings[i].spread, glm::length(step.d_dy), 1e-7 * spacings[i].spread);
      RayGenerator::RowSpacing one;
      rays.row_spacings({&x[i], &y[i], &z[i]}, {&one, 1});
      EXPECT_EQ(one.begin, spacings[i].begin);
      EXPECT_EQ(one.spread, spacings[i].spread);
    }
  }
  for (const SceneKernels* kernels : kSceneKernels.available()) {
    const std::array<float, 8> x = {1, 0, 0.5F, -3, 1e-20F, 2, 0, 1}, y = {0, 0, 1, 2, -1, 2, 7, 0},
                               z = {-1, -1, -2, 1, -1, 3, 0.1F, 1e-3F};
    std::array<double, 8> spreads{}, expected{};
    const DVec3 forward(0.1, 0.2, -0.9), down(0.001, -0.01, -0.0);
    kernels->row_spreads(forward, down, {x.data(), y.data(), z.data()}, spreads.data(), 8);
    kPortableScene.row_spreads(forward, down, {x.data(), y.data(), z.data()}, expected.data(), 8);
    EXPECT_EQ(spreads, expected) << kernels->name;
  }
}

TEST(SceneKernels, MakeTheRaysOfOtherCameras) {
  const Pose pose{.position = {1, 2, 3}, .direction = {0.3, 0.1, -1}};
  for (const Camera& camera :
       {Camera(OrthographicCamera{.pose = pose, .depth = {.near = 1}}),
        Camera(EnvironmentCamera{.pose = pose}), Camera(CalibratedCamera{.pose = pose}),
        Camera(CalibratedCamera{.pose = pose, .distortion = FisheyeDistortion{.k1 = 0.1}})}) {
    const RayGenerator rays(camera, {.width = 40, .height = 31});
    std::vector<Ray> row(40);
    rays.centers(0, 30, row);
    for (std::uint32_t i = 0; i < row.size(); ++i) expect_ray(row[i], rays(i + 0.5, 30.5));
    rays.centers(3, 4, 8, 0.25F, row);
    for (std::uint32_t i = 0; i < row.size(); ++i) {
      Ray expected = rays(3 + i % 8 + 0.5, 4 + i / 8 + 0.5);
      expected.t_min = std::max(expected.t_min, 0.25F);
      expect_ray(row[i], expected);
    }
  }
}

TEST(SceneKernels, DepthsAreThoseOfSinglePoints) {
  const Pose pose{.position = {1, 2, 3}, .direction = {0.3, 0.1, -1}};
  const std::vector<double> x{0, 1, -7.25}, y{0.1, 1e9, 2}, z{-3, 1e-9, 3};
  for (const Camera& camera :
       {Camera(PerspectiveCamera{.pose = pose}), Camera(EnvironmentCamera{.pose = pose})}) {
    const RayGenerator rays(camera, {});
    std::vector<float> depths(3);
    rays.depths(x, y, z, depths);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(depths[i], static_cast<float>(rays.depth({x[i], y[i], z[i]})));
  }
}

}  // namespace
}  // namespace microtrace
