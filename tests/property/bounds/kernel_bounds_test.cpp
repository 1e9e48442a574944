// Tests the kernels of every instruction set in the same way as bounds_test.cpp tests the filters.
// Each tree has one triangle and is queried by every function. The worst inputs with and without
// fused multiply-adds differ, so each bound has inputs for both.

#include "accel/few_triangles.hpp"
#include "accel/kernel_rays.hpp"
#include "accel/kernels/dispatch.hpp"
#include "accel/resolve/hit_resolver.hpp"
#include "accel/resolve/packet_resolver.hpp"
#include "exact/first_hit.hpp"
#include "exact/numbers/vector.hpp"
#include "support/reproduction.hpp"

#include <microtrace/primitives.hpp>
#include <microtrace/scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using Numbers = std::array<float, 15>;  // vertices, o, d

Vec3 vec3(const Numbers& numbers, std::size_t i) {
  return {numbers[i], numbers[i + 1], numbers[i + 2]};
}
exact::Root number(double t) {
  return exact::rational(exact::Dyadic(t), exact::Dyadic(1.0F));
}
float largest_component(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// A tree with one leaf, whose only block contains one triangle. Its vertices keep the given order.
class OneTriangle {
 public:
  explicit OneTriangle(const Numbers& v)
      : triangle_{vec3(v, 0), vec3(v, 3), vec3(v, 6)},
        ray_{.o = vec3(v, 9), .d = vec3(v, 12)},
        scene_(scene_of(triangle_)),
        primitives_(scene_),
        root_(exact::first_hit(triangle_, ray_)) {
    constexpr std::uint8_t kUnused = 3;
    const std::array vertices{triangle_.a, triangle_.b, triangle_.c, Vec3(std::nanf(""))};
    for (std::size_t i = 0; i < vertices.size(); ++i)
      for (int k = 0; k < 3; ++k) block_.vertices[k][i] = vertices[i][k];
    for (std::uint8_t i = 0; i < 3; ++i) {
      std::ranges::fill(block_.corners[i], kUnused);
      block_.corners[i][0] = i;
    }
    const float e1 = largest_component(triangle_.b - triangle_.a),
                e2 = largest_component(triangle_.c - triangle_.a);
    block_.largest_edge = std::max(e1, e2);
    block_.edge_product = e1 * e2 * (1 + 0x1p-22F) + 0x1p-126F;
  }

  void check(const Kernels& kernels) {
    SCOPED_TRACE(kernels.name);
    SCOPED_TRACE(adversarial::reproduction(ray_, triangle_));
    ASSERT_EQ(kernel_t_scale(ray_), 1);
    alone(kernels);
    in_a_tile(kernels);
    in_a_stream(kernels);
  }

  /// Checks the rounding of the ray's parameter at the triangle's plane, even if the ray misses the
  /// triangle.
  void check_rounding(const Kernels& kernels) const {
    SCOPED_TRACE(kernels.name);
    const exact::Vector a = exact::vector(triangle_.a),
                        n = cross(exact::vector(triangle_.b) - a, exact::vector(triangle_.c) - a);
    const float t = exact::round_to_float(
        exact::rational(dot(a - exact::vector(ray_.o), n), dot(exact::vector(ray_.d), n)));
    HitBatch batch{};
    float o[3][kHitBatch], d[3][kHitBatch];
    for (int k = 0; k < 3; ++k) {
      std::fill(batch.a[k], batch.a[k] + kHitBatch, triangle_.a[k]);
      std::fill(batch.b[k], batch.b[k] + kHitBatch, triangle_.b[k]);
      std::fill(batch.c[k], batch.c[k] + kHitBatch, triangle_.c[k]);
      std::fill(o[k], o[k] + kHitBatch, ray_.o[k]);
      std::fill(d[k], d[k] + kHitBatch, ray_.d[k]);
      batch.o[k] = o[k];
      batch.d[k] = d[k];
    }
    if (kernels.round_t(batch) != 0) {
      EXPECT_EQ(batch.t[0], t);
    }
    const std::vector<Ray> rays(kPacketRays, ray_);
    KernelPacket tile;
    ASSERT_TRUE(fill_packet(rays, kernels, tile));
    for (int k = 0; k < 3; ++k) {
      tile.hits.a[k][0] = triangle_.a[k];
      tile.hits.b[k][0] = triangle_.b[k];
      tile.hits.c[k][0] = triangle_.c[k];
    }
    tile.hits.count = 1;
    std::fill(tile.best_index, tile.best_index + kPacketRays, 0U);
    alignas(64) float tile_t[kPacketRays];
    if (kernels.round_t_of_packet(tile, tile_t) != 0) {
      EXPECT_EQ(tile_t[0], t);
    }
  }

 private:
  static Scene scene_of(const Triangle& triangle) {
    Scene scene;
    scene.objects.push_back({.name = "", .shape = triangle});
    return scene;
  }

  [[nodiscard]] TreeView tree() const {
    return {.nodes = nullptr, .blocks = &block_, .others = nullptr, .root = child_ref::kTriangles};
  }

  void expect_right(const ClosestSoFar& best) const {
    ASSERT_EQ(best.id != kNoPrimitive, root_.has_value());
    if (!root_) return;
    EXPECT_LE(number(best.lo), *root_);
    EXPECT_GE(number(best.hi), *root_);
  }

  void alone(const Kernels& kernels) const {
    HitResolver judge(primitives_, ray_);
    ClosestSoFar best = judge.no_hit();
    kernels.closest(tree(), kernel_ray(ray_, 1), judge.fallback(), best);
    expect_right(best);
    EXPECT_EQ(kernels.any(tree(), kernel_ray(ray_, 1), judge.fallback()), root_.has_value());
  }

  void in_a_tile(const Kernels& kernels) const {
    const std::vector<Ray> rays(kPacketRays, ray_);
    KernelPacket tile;
    ASSERT_TRUE(fill_packet(rays, kernels, tile));
    PacketResolver judge(primitives_, kernels, {}, rays, tile);
    kernels.closest_of_packet(tree(), tile, judge.fallback());
    for (int i = 0; i < kPacketRays; ++i)
      expect_right({tile.best_lo[i], tile.best_hi[i], tile.best_id[i]});
  }

  // Casts rays from different origins, as many as are needed for tracing them as packets.
  void in_a_stream(const Kernels& kernels) const {
    const auto stream = std::make_unique<KernelStream>();
    const StreamFallback slow{
        .context = const_cast<OneTriangle*>(this),
        .consider = [](void* self, int, std::uint32_t id, ClosestSoFar& best) {
          const auto& one = *static_cast<const OneTriangle*>(self);
          HitResolver(one.primitives_, one.ray_).consider(id, best);
        }};
    Tree whole;
    whole.blocks.push_back(block_);
    const std::unique_ptr<const FewTriangles> few = few_triangles(whole);
    for (const FewTriangles* triangles : {few.get(), static_cast<const FewTriangles*>(nullptr)}) {
      SCOPED_TRACE(triangles == nullptr ? "with traversal" : "without traversal");
      TreeView view = tree();
      view.few = triangles;
      fill(kernels, *stream);
      kernels.closest_of_stream(view, *stream, slow);
      for (int i = 0; i < stream->count; ++i)
        expect_right({stream->best_lo[i], stream->best_hi[i], stream->best_id[i]});
    }
    fill(kernels, *stream);
    kernels.any_of_stream(tree(), *stream, slow);
    for (int i = 0; i < stream->count; ++i)
      EXPECT_EQ(stream->best_id[i] != kNoPrimitive, root_.has_value());
  }
  void fill(const Kernels& kernels, KernelStream& stream) const {
    stream.count = kPacketRays;
    for (int i = 0; i < stream.count; ++i) {
      for (int k = 0; k < 3; ++k) stream.o[k][i] = ray_.o[k], stream.d[k][i] = ray_.d[k];
      stream.t_min[i] = ray_.t_min;
      stream.best_hi[i] = ray_.t_max;
      stream.omitted_id[i] = kNoPrimitive;
    }
    kernels.prepare_stream(stream);
  }

  Triangle triangle_;
  Ray ray_;
  Scene scene_;
  Primitives primitives_;
  std::optional<exact::Root> root_;
  TriangleBlock block_{};
};

template <std::size_t N>
void check(const std::array<Numbers, N>& cases) {
  for (const Numbers& numbers : cases) {
    for (const Kernels* kernels : kRayKernels.available()) OneTriangle(numbers).check(*kernels);
  }
}

TEST(KernelBounds, Edges) {
  check<4>({{
      {0x1.000006p+1F, -0x1.8a9dd6p-2F, -0x1.0d4ffp-3F, -0x1.e11b7ap-24F, -0x1.388eeap+1F,
       0x1.1821c2p-1F, 0x1.0be5ap-23F, 0x1.d0853cp+0F, 0x1.299944p+0F, -0x1.23c886p-23F,
       -0x1.8ab2f6p-2F, -0x1.0d4ff2p-3F, 0x1.22251ap-23F, 0x1.817f8cp-24F, 0x1.e2ac4ep-1F},
      {-0x1p+0F, 0x1.00008p+0F, 0x1.dc6d86p-1F, -0x1.01f19p+1F, -0x1.ef5cf8p-25F, 0x1.cf662ep-8F,
       -0x1.56357cp-25F, 0x1.07a982p-24F, 0x1.0a6798p-1F, -0x1.00002ap+0F, 0x1.ef62ccp-25F,
       0x1.e4481cp-1F, -0x1.3e3258p-18F, -0x1.4ed61cp-25F, -0x1.0a22f4p-1F},
      {-0x1.6d93fcp-4F, 0x1.35986ep+0F, 0x1.00ccbap+1F, 0x1.ef0adp+0F, 0x1.bcd63cp-3F,
       -0x1.179698p-20F, -0x1.220b42p+1F, 0x1.c149a4p+0F, 0x1.18d54ep-23F, -0x1.fa00f2p-4F,
       0x1.56eddap+0F, -0x1.07a1e6p-23F, -0x1.490842p-21F, -0x1.fe9302p+1F, -0x1.eba456p-19F},
      {-0x1.0349dp+1F, -0x1.e3d9c8p-24F, 0x1.225f4p-5F, 0x1.e1ddecp-24F, 0x1.02c268p+1F,
       -0x1.f00fp+0F, -0x1.201d9ap-20F, -0x1.02c268p+1F, -0x1.70e7eep+0F, -0x1.fc13aep-24F,
       -0x1.b84124p-7F, 0x1.225f38p-5F, -0x1.008068p-20F, 0x1.204578p-20F, -0x1.1c06c8p+2F},
  }});
}

TEST(KernelBounds, EdgesInATile) {
  check<2>({{
      {-0x1.954262p-5F, -0x1.000048p+1F, -0x1.3bd382p-11F, 0x1.00f18ap+1F, -0x1.000316p-23F,
       0x1.0849a6p+1F, 0x1.c89104p+0F, -0x1.80000cp-22F, -0x1.0ad1bep+1F, -0x1.23c4c8p-4F,
       -0x1.ffe11p-24F, -0x1.3bd588p-11F, 0x1.f01476p+14F, -0x1.fb6f0cp-10F, -0x1.fffe1ep-10F},
      {-0x1.c58fbcp-13F, 0x1.10384p+1F, 0x1.056d32p+1F, -0x1.056116p+1F, 0x1.30942cp-2F,
       -0x1.30c0fcp-21F, 0x1.0564e2p+1F, 0x1.f39d16p-2F, -0x1.350c22p-21F, -0x1.0002fep-10F,
       0x1.10384p+1F, 0x1.fc09f6p-24F, 0x1.2e4f82p-24F, -0x1.eddc74p-1F, -0x1.832d2ap-22F},
  }});
}

TEST(KernelBounds, EdgesInFloat64) {
  check<2>({{
      {-0x1.705038p-49F, 0x1.53f314p-4F, -0x1.0e1cf6p+0F, -0x1.199702p+0F, 0x1.2ebf18p+0F,
       -0x1.60236p-50F, 0x1.08075ap+0F, -0x1.95825ep-1F, 0x1.6fd788p-49F, 0x1.3d577cp-4F,
       -0x1.e7a3fcp-8F, 0x1.2040bep-50F, 0x1.5fbab2p-4F, 0x1.e41cb8p-1F, -0x1.727c4ap-50F},
      {0x0p+0F, -0x1.01684cp+0F, -0x1.e327fcp-53F, 0x1.50c0e6p-7F, 0x1.7d6a9ap-52F, 0x1.fa14ep-1F,
       0x1.23deacp-1F, -0x1.e09374p-50F, -0x1.0115b8p+0F, -0x1.06e268p-57F, -0x1.ff9808p-54F,
       0x1.80341cp-53F, 0x1.01a58ap-6F, -0x1.16c2e4p-55F, 0x1.517432p-58F},
  }});
}

TEST(KernelBounds, PlaneBehindTheRay) {
  check<2>({{
      {0x1.000004p+1F, -0x1.00008ap-2F, 0x1.00020ap-1F, -0x1.f4c734p-53F, -0x1.f4c734p-53F,
       0x1.682cdap-53F, 0x1.011fc4p+0F, 0x1.380586p+9F, 0x1.00022cp-1F, 0x1.db624ap-53F,
       0x1.1bc90cp-44F, 0x1.40f77ap-52F, -0x1.00001ap-2F, -0x1.c00004p-52F, 0x1.8ed07ap-53F},
      {0x1.83d55ap-4F, -0x1.00487ap+1F, 0x1.000406p+1F, 0x1.3f7dfap-3F, 0x1.024322p-52F,
       -0x1.f6e8ecp-53F, -0x1.ff38dp+5F, 0x0p+0F, -0x1.5e90fcp-46F, 0x1.a39d58p-6F, 0x1.f67522p-53F,
       -0x1.19d568p-52F, -0x1.fff5c4p-2F, -0x1.f67422p-53F, -0x1.7fbeb8p-51F},
  }});
}

TEST(KernelBounds, ParameterOfAHit) {
  check<3>({{
      {-0x1.003ffep+2F, -0x1.003fb4p+2F, -0x1.42f008p-16F, -0x1.3ffdd8p-20F, 0x1.3ffedap-20F,
       -0x1.004394p+2F, 0x1.dc148p-5F, -0x1.c00704p-20F, 0x1.02e3fap+2F, 0x1.bffd7cp-20F,
       -0x1.bffd74p-20F, 0x1.efc176p-16F, 0x1.02e41p+2F, 0x1.3ec554p-20F, -0x1.efc35ep-16F},
      {0x1.609002p-12F, 0x1.fec5a4p-18F, -0x1.000304p+0F, -0x1.00e65p+0F, -0x1.004074p+0F,
       0x1.7ffe02p-23F, -0x1.fffff8p-1F, 0x1.00406cp+0F, 0x1.fffffap-25F, -0x1.8013bp-22F,
       -0x1.3ffbecp-22F, -0x1.000316p+0F, -0x1.044138p+0F, 0x1.40198cp-12F, 0x1.049ab8p+0F},
      {-0x1.04p+0F, 0x1.f0fffep-14F, -0x1.040496p+0F, -0x1.08c8p-11F, 0x1.03fff4p+0F,
       0x1.bfffccp-22F, -0x1.be4p-14F, -0x1.ffff7ep-1F, -0x1p-24F, -0x1.790006p-16F,
       -0x1.706036p-13F, 0x1.2888p-11F, 0x1.000812p-1F, 0x1.f0ffc2p-14F, -0x1.80004p-26F},
  }});
}

TEST(KernelBounds, RoundedParameter) {
  // Each case is a plane and a ray. In the last case, the packet's bound of the slope equals the
  // ray's own.
  constexpr std::array<Numbers, 3> cases = {{
      {-0x1.1c343ep+1F, -0x1.6p-26F, 0x1.040022p+1F, -0x1.d2a5acp+0F, 0x1.000004p+1F,
       0x1.000002p+1F, 0x1.80007p-51F, -0x1.6a4a92p-47F, 0x1.4006f4p-50F, 0x1.3ffc6ap-50F,
       0x1.6ae684p-18F, -0x1.400096p-50F, 0x1.43708cp+2F, -0x1.c28fbcp-1F, -0x1.a59fb4p+0F},
      {-0x1.00001ep+1F, 0x1.00009ap+1F, -0x1.67feaep-23F, -0x1.ffffe6p+0F, 0x1.c007bap-50F,
       0x1.ffffe4p+0F, 0x1.3fffe8p-27F, -0x1.fa10b8p-28F, -0x1.bfef84p-27F, -0x1.b318b4p-1F,
       0x1.e2cb0cp+1F, -0x1.3711f2p+0F, -0x1.000024p+0F, 0x1.00002ap-23F, 0x1.00001ap+0F},
      {-0x1.fdfffcp-2F, 0x1.cb02f4p-52F, -0x1.002becp-55F, -0x1.1982bcp-21F, -0x1.a4e17ep-55F,
       0x1.fdffc4p-2F, -0x1.fff856p+0F, 0x1.042p+2F, -0x1.0021ccp-1F, 0x1.55fb48p-1F, 0x1.56a2dp-2F,
       -0x1.598e1p-2F, 0x1.000002p-1F, 0x1.c1125cp-50F, 0x1.fffffp-2F},
  }};
  for (const Numbers& numbers : cases) {
    for (const Kernels* kernels : kRayKernels.available())
      OneTriangle(numbers).check_rounding(*kernels);
  }
}

// Checks (x - o) / d, the distance to a plane of a box, rounded down and rounded up.
TEST(KernelBounds, Slabs) {
  struct Slab {
    float x, o, d;
  };
  constexpr std::array<Slab, 3> nearer = {{{0x1.23ba12p+2F, -0x1.ee1576p-2F, 0x1.e4093ep+0F},
                                           {0x1.dbbb5p+0F, -0x1.67bf78p-2F, 0x1.b94ce8p+0F},
                                           {0x1.456aa8p+1F, -0x1.bcaaaap-2F, 0x1.1d8242p+0F}}};
  constexpr std::array<Slab, 3> farther = {{{0x1.469d1p+1F, -0x1.735808p-5F, 0x1.123476p+0F},
                                            {0x1.d550b2p+1F, -0x1.c6ff8p-2F, 0x1.057014p+0F},
                                            {0x1.696edcp+2F, -0x1.d187dep-3F, 0x1.fa2f64p+0F}}};
  const auto stream = std::make_unique<KernelStream>();
  for (const Kernels* kernels : kRayKernels.available()) {
    SCOPED_TRACE(kernels->name);
    const auto ask = [&](const Slab& slab) {
      stream->count = kPacketRays;
      for (int i = 0; i < stream->count; ++i) {
        for (int k = 0; k < 3; ++k) stream->o[k][i] = slab.o, stream->d[k][i] = slab.d;
        stream->t_min[i] = 0;
        stream->best_hi[i] = 1;
      }
      kernels->prepare_stream(*stream);
    };
    // In float64, the differences and the products with d are exact.
    for (const Slab& slab : nearer) {
      ask(slab);
      const float t = (slab.x - slab.o) * stream->near[0][0];
      EXPECT_LE(double{t} * slab.d, double{slab.x} - slab.o);
    }
    for (const Slab& slab : farther) {
      ask(slab);
      const float t = (slab.x - slab.o) * stream->far[0][0];
      EXPECT_GE(double{t} * slab.d, double{slab.x} - slab.o);
    }
  }
}

}  // namespace
}  // namespace microtrace
