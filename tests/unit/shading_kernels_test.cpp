// Compares shading kernels with the scalar code, bit by bit, for every instruction set of this
// machine.
#include "render/bsdf/bsdf.hpp"
#include "render/bsdf/frame.hpp"
#include "render/integrators/path_state.hpp"
#include "render/integrators/plain_vertices.hpp"
#include "render/kernels/dispatch.hpp"
#include "render/kernels/lane_access.hpp"
#include "render/shading/normals.hpp"
#include "render/shading/surface_point.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/scene.hpp>

#include <algorithm>
#include <bit>
#include <random>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr int kRounds = 500;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  float unit() { return static_cast<float>(engine_() >> 8U) * 0x1p-24F; }
  float signed_unit() { return 2 * unit() - 1; }
  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
  Vec3 vector() { return {signed_unit(), signed_unit(), signed_unit()}; }
  Vec3 color() { return {unit(), unit(), unit()}; }
  Vec3 direction() { return bsdf::unit(vector() + Vec3(0, 0, 1e-3F)); }
  /// A direction above the plane with this normal.
  Vec3 above(const Vec3& n) {
    const Vec3 w = direction();
    return glm::dot(w, n) < 0 ? -w : w;
  }

 private:
  std::mt19937 engine_;
};

/// Equal bits; NaN equals NaN.
void expect_bits(float a, float b, const char* what) {
  if (std::isnan(a) && std::isnan(b)) return;
  ASSERT_EQ(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b))
      << what << ": " << a << " instead of " << b;
}
void expect_bits(const Vec3& a, const Vec3& b, const char* what) {
  for (int k = 0; k < 3; ++k) expect_bits(a[k], b[k], what);
}

class ShadingKernelsTest : public testing::TestWithParam<const ShadingKernels*> {};

TEST_P(ShadingKernelsTest, PointsEqualTheScalarCode) {
  Random random(1);
  HitLanes lanes{};
  int asked = 0;
  for (int round = 0; round < kRounds; ++round) {
    Mesh mesh{.positions = {}, .triangles = {}};
    mesh.uv_sets.emplace_back();
    for (std::uint32_t i = 0; i < kShadingLanes; ++i) {
      const float size = std::exp2(20 * random.signed_unit());
      for (int k = 0; k < 3; ++k) {
        mesh.positions.push_back(size * random.vector());
        // Some normals are zero.
        mesh.normals.push_back(random.unit() < 0.1F ? Vec3(0) : random.direction());
        mesh.uv_sets[0].push_back({random.signed_unit(), random.signed_unit()});
      }
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    Scene scene;
    scene.objects.push_back({.name = "", .shape = mesh});
    const Primitives primitives(scene);
    std::array<Ray, kShadingLanes> rays;
    std::array<Hit, kShadingLanes> hits;
    for (int i = 0; i < kShadingLanes; ++i) {
      const auto place = static_cast<std::size_t>(i);
      const Triangle t = triangle_of(mesh, place);
      const float u = random.unit(), v = (1 - u) * random.unit();
      const Vec3 target = t.a + u * (t.b - t.a) + v * (t.c - t.a);
      const Vec3 o = target + 3.0F * glm::length(t.b - t.a) * random.direction();
      rays[place] = {.o = o, .t_min = 0, .d = (target - o) * random.unit()};
      const DVec3 n = glm::cross(DVec3(t.b) - DVec3(t.a), DVec3(t.c) - DVec3(t.a));
      const double along = glm::dot(n, DVec3(rays[place].d));
      hits[place] = {.id = static_cast<PrimitiveId>(i),
                     .t = static_cast<float>(glm::dot(DVec3(t.a) - DVec3(o), n) / along)};
      put(lanes.o, i, rays[place].o);
      put(lanes.d, i, rays[place].d);
      lanes.t[i] = hits[place].t;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        put(lanes.corners[corner], i, mesh.positions[3 * place + corner]);
        put(lanes.normals[corner], i, mesh.normals[3 * place + corner]);
        lanes.uv[corner][0][i] = mesh.uv_sets[0][3 * place + corner].x;
        lanes.uv[corner][1][i] = mesh.uv_sets[0][3 * place + corner].y;
      }
    }
    GetParam()->find_points(lanes);
    for (int i = 0; i < kShadingLanes; ++i) {
      const auto place = static_cast<std::size_t>(i);
      if (lanes.is_sure[i] == 0) continue;
      ++asked;
      const SurfacePoint at = surface_point(primitives, rays[place], hits[place], &mesh, place);
      expect_bits(got(lanes.p, i), at.p, "p");
      expect_bits(got(lanes.n, i), at.n, "n");
      expect_bits(got(lanes.ns, i), at.ns, "ns");
      expect_bits(got(lanes.weights, i), at.barycentrics, "weights");
      expect_bits(lanes.first_uv[0][i], at.first_uv.x, "u");
      expect_bits(lanes.first_uv[1][i], at.first_uv.y, "v");
      expect_bits(lanes.uv_scale[i], at.uv_scale, "uv_scale");
      expect_bits(lanes.distance[i], at.distance, "distance");
      ASSERT_EQ(lanes.from_behind[i] == 0, at.front);
    }
  }
  EXPECT_GT(asked, kRounds * kShadingLanes * 0.95);
}

TEST_P(ShadingKernelsTest, UncertainPointsAreMarked) {
  HitLanes lanes{};  // no triangle has an area
  for (float& t : lanes.t) t = 1;
  GetParam()->find_points(lanes);
  for (const float sure : lanes.is_sure) EXPECT_EQ(sure, 0);
}

TEST_P(ShadingKernelsTest, NormalsEqualTheScalarCode) {
  Random random(2);
  NormalLanes lanes{};
  int turned = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::array<Vec3, kShadingLanes> expected;
    for (int i = 0; i < kShadingLanes; ++i) {
      Mesh mesh{.positions = {}, .triangles = {}};
      const float handedness = random.unit() < 0.5F ? 1.0F : -1.0F;
      for (int corner = 0; corner < 3; ++corner)
        mesh.tangents.emplace_back(random.direction(), handedness);
      ShadingPoint point;
      point.at.mesh = &mesh;
      point.at.corners = {0, 1, 2};
      point.at.barycentrics = random.color();
      point.at.n = random.direction();
      point.at.ns = bsdf::unit(point.at.n + random.unit() * random.vector());
      point.at.front = random.unit() < 0.5F;
      const float side = point.at.front ? 1.0F : -1.0F;
      const Vec3 d = -random.above(side * point.at.n) * (random.unit() + 0.1F);
      Image image{.width = 1, .height = 1, .channels = 3};
      image.samples = std::vector<std::uint8_t>{static_cast<std::uint8_t>(random.bits()),
                                                static_cast<std::uint8_t>(random.bits()),
                                                static_cast<std::uint8_t>(random.bits())};
      const TextureMap map(image, Sampler{}, ColorEncoding::linear);
      const TextureUse use;
      TextureSlot slot{.map = &map, .use = &use};
      if (random.unit() < 0.3F) slot = {};
      const float scale = 2 * random.unit();
      expected[static_cast<std::size_t>(i)] = usable_normal(
          side * mapped_normal(point, slot, scale), side * point.at.n, -bsdf::unit(d));
      turned += expected[static_cast<std::size_t>(i)] == side * point.at.ns ? 0 : 1;
      put(lanes.d, i, d);
      put(lanes.n, i, point.at.n);
      put(lanes.ns, i, point.at.ns);
      lanes.side[i] = side;
      put(lanes.texel, i, Vec3(slot.at(point)));
      lanes.scale[i] = scale;
      for (std::size_t corner = 0; corner < 3; ++corner)
        put(lanes.tangents[corner], i, Vec3(mesh.tangents[corner]));
      put(lanes.weights, i, point.at.barycentrics);
      lanes.handedness[i] = slot.map == nullptr ? 0 : handedness;
    }
    GetParam()->find_normals(lanes);
    for (int i = 0; i < kShadingLanes; ++i)
      expect_bits(got(lanes.frame_n, i), expected[static_cast<std::size_t>(i)], "normal");
  }
  EXPECT_GT(turned, kRounds * kShadingLanes / 2);
}

struct Scattered {
  Vec3 shadow{0}, wi{0}, throughput{0};
  float pdf = 0;
};

/// The result of the scalar code.
Scattered scattered(const ScatterLanes& lanes, int i, const WaveStep& step) {
  Scattered result;
  const bsdf::Frame frame = bsdf::Frame::about(got(lanes.frame_n, i));
  Vec3 wo = frame.to_local(-bsdf::unit(got(lanes.d, i)));
  wo.z = std::max(wo.z, 1e-5F);
  const bsdf::Bsdf bsdf({.base_color = got(lanes.base_color, i),
                         .metallic = lanes.metallic[i],
                         .roughness = lanes.roughness[i],
                         .dielectric = {.f0 = got(lanes.f0, i), .f90 = lanes.f90[i]}},
                        wo);
  const Vec3 outwards = got(lanes.outwards, i), throughput = got(lanes.throughput, i);
  const Vec3 to_light = got(lanes.light_wi, i), light_wi = frame.to_local(to_light);
  if (light_wi.z > 0 && glm::dot(to_light, outwards) > 0) {
    const bsdf::Evaluation f = bsdf.evaluate(light_wi);
    const float weight = lanes.light_pdf[i] > 0 ? power_heuristic(lanes.light_pdf[i], f.pdf) : 1;
    result.shadow = throughput * f.value * got(lanes.light, i) * weight;
  }
  const sampling::Sobol sobol(lanes.key[i], lanes.index[i]);
  const Vec2 chances = sobol.pair(step.pair(sampling::kLobePair));
  const auto sample = bsdf.sample(sobol.pair(step.pair(sampling::kDirectionPair)), chances.x);
  if (!sample) return result;
  result.wi = frame.to_world(sample->wi);
  if (!(glm::dot(result.wi, outwards) > 0)) return result;
  result.throughput = throughput * sample->weight;
  if (const float most = step.most_survival(); most < 1) {
    const Vec3& t = result.throughput;
    const float survival = std::min(std::max({t.x, t.y, t.z}), most);
    if (!(chances.y < survival)) return result;
    result.throughput /= survival;
  }
  result.pdf = sample->pdf;
  return result;
}

TEST_P(ShadingKernelsTest, ScatteringEqualsTheScalarCode) {
  Random random(3);
  ScatterLanes lanes{};
  int lit = 0, alive = 0;
  for (int round = 0; round < kRounds; ++round) {
    const WaveStep step{.depth = 1 + static_cast<std::uint32_t>(round % 6)};
    for (int i = 0; i < kShadingLanes; ++i) {
      const Vec3 n = random.direction(), outwards = bsdf::unit(n + 0.3F * random.vector());
      put(lanes.frame_n, i, n);
      put(lanes.outwards, i, outwards);
      put(lanes.d, i, -random.above(n) * (random.unit() + 0.1F));
      put(lanes.base_color, i, random.unit() < 0.2F ? Vec3(0) : random.color());
      lanes.metallic[i] = std::clamp(1.5F * random.unit() - 0.25F, 0.0F, 1.0F);
      lanes.roughness[i] = random.unit() * random.unit();
      put(lanes.f0, i, random.unit() < 0.5F ? Vec3(0.04F) : random.color());
      lanes.f90[i] = random.unit() < 0.5F ? 1 : random.unit();
      put(lanes.throughput, i, 1.5F * random.color());
      put(lanes.light_wi, i, random.direction());
      put(lanes.light, i, 5.0F * random.color());
      lanes.light_pdf[i] = random.unit() < 0.2F ? 0 : random.unit();
      lanes.key[i] = random.bits();
      lanes.index[i] = random.bits() >> (random.bits() & 31U);
    }
    GetParam()->scatter(scatter_setup(step), lanes);
    for (int i = 0; i < kShadingLanes; ++i) {
      const Scattered expected = scattered(lanes, i, step);
      expect_bits(got(lanes.shadow, i), expected.shadow, "shadow");
      expect_bits(lanes.pdf[i], expected.pdf, "pdf");
      lit += expected.shadow == Vec3(0) ? 0 : 1;
      if (expected.pdf == 0) continue;
      ++alive;
      expect_bits(got(lanes.wi, i), expected.wi, "wi");
      expect_bits(got(lanes.next_throughput, i), expected.throughput, "throughput");
    }
  }
  EXPECT_GT(lit, kRounds * kShadingLanes / 4);
  EXPECT_GT(alive, kRounds * kShadingLanes / 4);
}

INSTANTIATE_TEST_SUITE_P(Isa, ShadingKernelsTest, testing::ValuesIn(available_shading_kernels()),
                         [](const auto& set) { return std::string(set.param->name); });

}  // namespace
}  // namespace microtrace
