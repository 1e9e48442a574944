// Compares the shading kernels of every instruction set of this machine bit by bit with the
// one-lane instance.
#include "render/integrators/wavefront/path_state.hpp"
#include "render/integrators/wavefront/vertices/vertex_queue.hpp"
#include "render/kernels/find_normals.hpp"
#include "render/kernels/scatter.hpp"
#include "render/lanes/dispatch.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/shading/points/find_points.hpp"
#include "support/lane_tests.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

class ShadingKernelsTest : public testing::TestWithParam<const ShadingKernels*> {};

TEST_P(ShadingKernelsTest, PointsHaveTheBitsOfOneLane) {
  LaneRandom random(1);
  int asked = 0;
  for (int round = 0; round < kRounds; ++round) {
    HitLanes lanes{};
    for (int i = 0; i < kShadingLanes; ++i) {
      const float size = std::exp2(20 * random.signed_unit());
      std::array<Vec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = size * random.vector();
        put(lanes.corners[k], i, corners[k]);
        // Some normals are zero.
        put(lanes.normals[k], i, random.number() < 0.1F ? Vec3(0) : random.direction());
        lanes.uv[k][0][i] = random.signed_unit();
        lanes.uv[k][1][i] = random.signed_unit();
      }
      const auto& [a, b, c] = corners;
      const float u = random.number(), v = (1 - u) * random.number();
      const Vec3 target = a + u * (b - a) + v * (c - a);
      const Vec3 o = target + 3.0F * glm::length(b - a) * random.direction();
      const Vec3 d = (target - o) * random.number();
      put(lanes.o, i, o);
      put(lanes.d, i, d);
    }
    HitLanes expected = lanes;
    GetParam()->find_points(lanes);
    find_points<1>(expected);
    for (int i = 0; i < kShadingLanes; ++i) {
      expect_bits(lanes.is_sure[i], expected.is_sure[i], "is_sure");
      if (lanes.is_sure[i] == 0) continue;
      ++asked;
      expect_bits(lanes.p, expected.p, i, "p");
      expect_bits(lanes.n, expected.n, i, "n");
      expect_bits(lanes.ns, expected.ns, i, "ns");
      expect_bits(lanes.weights, expected.weights, i, "weights");
      expect_bits(lanes.first_uv, expected.first_uv, i, "uv");
      expect_bits(lanes.first_uv_scale[i], expected.first_uv_scale[i], "first_uv_scale");
      expect_bits(lanes.distance[i], expected.distance[i], "distance");
      expect_bits(lanes.from_behind[i], expected.from_behind[i], "from_behind");
    }
  }
  EXPECT_GT(asked, kRounds * kShadingLanes * 0.95);
}

TEST_P(ShadingKernelsTest, FlatTrianglesHaveTheBitsOfOtherTriangles) {
  LaneRandom random(8);
  for (int round = 0; round < kRounds; ++round) {
    std::array<FlatTriangle, kShadingLanes + 1> table{};
    FlatHits flat{};
    HitLanes lanes{};
    for (int i = 0; i < kShadingLanes; ++i) {
      FlatTriangle& row = table[static_cast<std::size_t>(kShadingLanes - i)];
      const Vec3 a = random.vector(), b = random.vector(), c = random.vector();
      const float u = random.number(), v = (1 - u) * random.number();
      put(lanes.corners[0], i, a);
      put(lanes.corners[1], i, b);
      put(lanes.corners[2], i, c);
      put(lanes.o, i, random.vector());
      put(lanes.d, i, a + u * (b - a) + v * (c - a) - got(lanes.o, i));
      flat.rows[i] = random.number() < 0.2F ? 0 : static_cast<std::uint32_t>(kShadingLanes - i);
      row.surface = static_cast<std::uint32_t>(i);
      row.kind = static_cast<std::uint32_t>(i % 8);
      row.is_flat = 1;
    }
    HitLanes expected = lanes;
    find_points<1>(expected);
    for (int i = 0; i < kShadingLanes; ++i) {
      FlatTriangle& row = table[static_cast<std::size_t>(kShadingLanes - i)];
      for (int axis = 0; axis < 3; ++axis) {
        row.n[axis] = expected.n[axis][i];
        for (int corner = 0; corner < 3; ++corner)
          row.corners[corner][axis] = lanes.corners[corner][axis][i];
      }
    }
    for (int i = 0; i < kShadingLanes; ++i) {
      for (auto* vectors : {&lanes.p, &lanes.n, &lanes.ns}) put(*vectors, i, random.vector());
      lanes.is_sure[i] = lanes.distance[i] = lanes.from_behind[i] = random.number();
    }
    const HitLanes before = lanes;
    for (int i = 0; i < kShadingLanes; ++i) {
      for (auto& corner : lanes.corners)
        if (flat.rows[i] != 0) put(corner, i, Vec3(7));
    }
    GetParam()->find_flat_points(table.data(), flat, lanes);
    for (int i = 0; i < kShadingLanes; ++i) {
      const bool is_flat = flat.rows[i] != 0;
      const HitLanes& right = is_flat ? expected : before;
      expect_bits(lanes.is_sure[i], right.is_sure[i], "is_sure");
      expect_bits(lanes.p, right.p, i, "p");
      expect_bits(lanes.n, right.n, i, "n");
      expect_bits(lanes.ns, right.ns, i, "ns");
      expect_bits(lanes.distance[i], right.distance[i], "distance");
      expect_bits(lanes.from_behind[i], right.from_behind[i], "from_behind");
      for (int corner = 0; corner < 3; ++corner)
        expect_bits(lanes.corners[corner], right.corners[corner], i, "corners");
      if (!is_flat) continue;
      EXPECT_EQ(flat.surfaces[i], static_cast<std::uint32_t>(i));
      EXPECT_EQ(flat.simple >> i & 1U, i & 1U);
      EXPECT_EQ(flat.with_back >> i & 1U, i >> 1 & 1U);
      EXPECT_EQ(flat.with_open_back >> i & 1U, i >> 2 & 1U);
    }
  }
}

TEST_P(ShadingKernelsTest, SurfacesAreLoaded) {
  LaneRandom random(9);
  std::array<FlatSurface, 5> table{};
  for (FlatSurface& row : table) {
    row = {.base_color = {random.number(), random.number(), random.number()},
           .metallic = random.number(),
           .roughness = random.number(),
           .f0 = {random.number(), random.number(), random.number()},
           .f90 = random.number(),
           .unused = {}};
  }
  std::uint32_t which[kShadingLanes];
  for (std::uint32_t i = 0; i < kShadingLanes; ++i) which[i] = i * 7 % 5;
  SurfaceLanes lanes{};
  GetParam()->load_surfaces(table.data(), which, lanes);
  for (std::size_t i = 0; i < kShadingLanes; ++i) {
    const FlatSurface& row = table[which[i]];
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(lanes.base_color[k][i], row.base_color[k]);
      EXPECT_EQ(lanes.f0[k][i], row.f0[k]);
    }
    EXPECT_EQ(lanes.metallic[i], row.metallic);
    EXPECT_EQ(lanes.roughness[i], row.roughness);
    EXPECT_EQ(lanes.f90[i], row.f90);
  }
}

TEST_P(ShadingKernelsTest, UncertainPointsAreMarked) {
  HitLanes lanes{};  // all triangles are degenerate
  GetParam()->find_points(lanes);
  for (const float sure : lanes.is_sure) EXPECT_EQ(sure, 0);
}

// The points of triangles that are nearly edge-on must not be used, because their error is large.
TEST_P(ShadingKernelsTest, SurePointsAreExactWithinFloat32) {
  LaneRandom random(7);
  int sure = 0;
  for (int round = 0; round < kRounds; ++round) {
    HitLanes lanes{};
    std::array<Vec3, kShadingLanes> targets;
    for (int i = 0; i < kShadingLanes; ++i) {
      const Vec3 a = random.vector(), b = random.vector(), c = random.vector();
      const float u = random.number(), v = (1 - u) * random.number();
      const Vec3 target = a + u * (b - a) + v * (c - a);
      const Vec3 n = unit<1>(glm::cross(b - a, c - a));
      // A direction with an angle of down to 2^-40 to the plane.
      const Vec3 d = unit<1>(b - a) + std::exp2(20 * random.signed_unit() - 20) * n;
      put(lanes.corners[0], i, a);
      put(lanes.corners[1], i, b);
      put(lanes.corners[2], i, c);
      put(lanes.o, i, target - d);
      put(lanes.d, i, d);
      targets[static_cast<std::size_t>(i)] = target;
    }
    GetParam()->find_points(lanes);
    for (int i = 0; i < kShadingLanes; ++i) {
      if (lanes.is_sure[i] == 0) continue;
      ++sure;
      // The exact point on the triangle's plane, from the rounded ray.
      const auto exact = [](float x) { return static_cast<long double>(x); };
      long double e1[3], e2[3], from[3];
      for (int k = 0; k < 3; ++k) {
        e1[k] = exact(lanes.corners[1][k][i]) - exact(lanes.corners[0][k][i]);
        e2[k] = exact(lanes.corners[2][k][i]) - exact(lanes.corners[0][k][i]);
        from[k] = exact(lanes.corners[0][k][i]) - exact(lanes.o[k][i]);
      }
      long double height = 0, slope = 0;
      for (int k = 0; k < 3; ++k) {
        const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        const long double normal = e1[k1] * e2[k2] - e1[k2] * e2[k1];
        height += normal * from[k];
        slope += normal * exact(lanes.d[k][i]);
      }
      for (int k = 0; k < 3; ++k) {
        const long double p = exact(lanes.o[k][i]) + height / slope * exact(lanes.d[k][i]);
        EXPECT_NEAR(static_cast<double>(p), double{lanes.p[k][i]}, 0x1p-21);
      }
    }
  }
  EXPECT_GT(sure, kRounds * kShadingLanes / 4);
  EXPECT_LT(sure, kRounds * kShadingLanes * 3 / 4);
}

TEST_P(ShadingKernelsTest, LanesAreAppendedInOrder) {
  LaneRandom random(8);
  for (int round = 0; round < 10 * kRounds; ++round) {
    float from[2][3 * kShadingLanes], to[2][2 * kShadingLanes];
    for (auto& column : from)
      for (float& x : column) x = random.number();
    for (auto& column : to) std::ranges::fill(column, -1.0F);
    const std::uint32_t lanes = round == 0 ? 0xffff : random.bits() & random.bits() & 0xffff;
    const bool fills_lanes = random.number() < 0.5F;
    const auto count = static_cast<std::size_t>(std::popcount(lanes));
    const std::size_t first = random.bits() % (2 * kShadingLanes),
                      end = random.bits() % (kShadingLanes - (fills_lanes ? count : 0) + 1);
    const ColumnCopy columns[] = {{from[0], to[0]}, {from[1], to[1]}};
    GetParam()->append(columns, 2,
                       {.lanes = lanes, .from = first, .to = end, .fills_lanes = fills_lanes});
    for (int column = 0; column < 2; ++column) {
      std::size_t place = end;
      for (std::size_t lane = 0; lane < kShadingLanes; ++lane) {
        if ((lanes >> lane & 1U) != 0) {
          ASSERT_EQ(to[column][place++], from[column][first + lane]);
        }
      }
      // Other elements remain unchanged, except for those that may be overwritten.
      const std::size_t after = fills_lanes ? place : end + kShadingLanes;
      for (std::size_t k = 0; k < 2 * kShadingLanes; ++k) {
        if (k < end || k >= after) {
          ASSERT_EQ(to[column][k], -1);
        }
      }
    }
  }
}

TEST_P(ShadingKernelsTest, NormalsHaveTheBitsOfOneLane) {
  LaneRandom random(2);
  int turned = 0;
  for (int round = 0; round < kRounds; ++round) {
    NormalLanes points{};
    NormalMapLanes map{};
    for (int i = 0; i < kShadingLanes; ++i) {
      const Vec3 n = random.direction();
      points.side[i] = random.number() < 0.5F ? 1.0F : -1.0F;
      put(points.n, i, n);
      put(points.ns, i, unit<1>(n + random.number() * random.vector()));
      put(points.d, i, -random.above(points.side[i] * n) * (random.number() + 0.1F));
      for (auto& tangent : points.tangents) put(tangent, i, random.direction());
      put(points.weights, i, random.color());
      points.handedness[i] = static_cast<float>(random.bits() % 3) - 1;
      map.is_mapped[i] = random.number() < 0.3F ? 0.0F : 1.0F;
      put(map.texel, i, random.color());
      map.scale[i] = 2 * random.number();
    }
    NormalMapLanes expected = map;
    GetParam()->find_normals(points, map);
    find_normals<1>(points, expected);
    for (int i = 0; i < kShadingLanes; ++i) {
      expect_bits(map.normal, expected.normal, i, "normal");
      turned += got(map.normal, i) == points.side[i] * got(points.ns, i) ? 0 : 1;
    }
  }
  EXPECT_GT(turned, kRounds * kShadingLanes / 2);
}

void put_any_surface(SurfaceLanes& lanes, int i, LaneRandom& random) {
  const auto factor = [&] { return std::clamp(1.5F * random.number() - 0.25F, 0.0F, 1.0F); };
  put(lanes.base_color, i, random.number() < 0.2F ? Vec3(0) : random.color());
  lanes.metallic[i] = factor();
  lanes.roughness[i] = random.number() * random.number();
  put(lanes.f0, i, random.number() < 0.5F ? Vec3(0.04F) : random.color());
  lanes.f90[i] = random.number() < 0.5F ? 1 : random.number();
  lanes.transmission[i] = factor();
  lanes.eta[i] = random.number() < 0.5F ? 1 + random.number() : 1 / (1 + random.number());
  lanes.diffuse_transmission[i] = factor();
  put(lanes.diffuse_transmission_color, i, random.color());
  lanes.anisotropy[i] = factor();
  put(lanes.along, i, random.vector());
  lanes.film_share[i] = factor();
  lanes.film_ior[i] = 1 + random.number();
  // Some film thicknesses exceed the range of the fast argument reduction.
  lanes.film_thickness[i] = random.number() < 0.1F ? 1e12F : 1000 * random.number();
  put(lanes.sheen, i, random.number() < 0.2F ? Vec3(0) : random.color());
  lanes.sheen_roughness[i] = random.number();
  lanes.coat[i] = factor();
  lanes.coat_roughness[i] = random.number();
}

void remove_specular_reflection(SurfaceLanes& lanes, int i) {
  lanes.metallic[i] = 0;
  put(lanes.f0, i, Vec3(0));
  lanes.f90[i] = 0;
}

bsdf::Features any_features(LaneRandom& random) {
  const auto chance = [&] { return random.number() < 0.3F; };
  bsdf::Features result{.is_anisotropic = chance(), .has_film = chance(), .transmits = chance()};
  result.refracts = result.transmits && random.number() < 0.5F;
  if (chance()) result.layers = static_cast<bsdf::LayerSide>(random.bits() % 4);
  return result;
}

TEST_P(ShadingKernelsTest, ScatteringHasTheBitsOfOneLane) {
  LaneRandom random(3);
  int lit = 0, alive = 0, below = 0;
  for (int round = 0; round < 4 * kRounds; ++round) {
    ScatterLanes lanes{};
    const WaveStep step{.depth = 1 + static_cast<std::uint32_t>(round % 6),
                        .is_spec = round % 4 == 3};
    const bsdf::Features features = any_features(random);
    // One lane evaluates matte surfaces by shorter formulas, several lanes only if all are matte.
    const float matte = round % 3 == 0 ? 1.0F : 0.3F;
    for (int i = 0; i < kShadingLanes; ++i) {
      const Vec3 n = random.direction(), outwards = unit<1>(n + 0.3F * random.vector());
      put(lanes.frame_n, i, n);
      put(lanes.outwards, i, outwards);
      put(lanes.d, i, -random.above(n) * (random.number() + 0.1F));
      put_any_surface(lanes.surface, i, random);
      if (random.number() < matte) remove_specular_reflection(lanes.surface, i);
      put(lanes.surface.coat_normal, i,
          random.number() < 0.5F ? n : unit<1>(n + 0.2F * random.vector()));
      put(lanes.throughput, i, 1.5F * random.color());
      put(lanes.through_weight, i, random.color());
      put(lanes.light_wi, i, random.direction());
      put(lanes.light, i, 5.0F * random.color());
      lanes.light_pdf[i] = random.number() < 0.2F ? 0 : random.number();
      lanes.key[i] = random.bits();
      lanes.index[i] = random.bits() >> (random.bits() & 31U);
    }
    ScatterLanes expected = lanes;
    GetParam()->scatter(scatter_setup(step, features), lanes);
    scatter<1>(scatter_setup(step, features), expected);
    for (int i = 0; i < kShadingLanes; ++i) {
      expect_bits(lanes.shadow, expected.shadow, i, "shadow");
      expect_bits(lanes.pdf[i], expected.pdf[i], "pdf");
      lit += got(lanes.shadow, i) == Vec3(0) ? 0 : 1;
      ASSERT_FALSE(std::isnan(lanes.pdf[i]) || std::isnan(lanes.shadow[0][i]));
      if (lanes.pdf[i] == 0) continue;
      ++alive;
      expect_bits(lanes.wi, expected.wi, i, "wi");
      expect_bits(lanes.next_throughput, expected.next_throughput, i, "throughput");
      if (!features.transmits) continue;
      expect_bits(lanes.is_below[i], expected.is_below[i], "is_below");
      below += lanes.is_below[i] != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(lit, kRounds * kShadingLanes);
  EXPECT_GT(alive, kRounds * kShadingLanes);
  EXPECT_GT(below, kRounds * kShadingLanes / 20);
}

INSTANTIATE_TEST_SUITE_P(Isa, ShadingKernelsTest, testing::ValuesIn(kShadingKernels.available()),
                         [](const auto& set) { return std::string(set.param->name); });

}  // namespace
}  // namespace microtrace
