// Compares the queries of RayTracer for rays in columns with Bvh::intersect and Bvh::next, ray by
// ray, for every instruction set of the machine.

#include "accel/kernels/dispatch.hpp"
#include "accel/ray_tracer.hpp"
#include "accel/resolve/open_side.hpp"
#include "render/shading/primitive_set.hpp"
#include "support/cases/adversarial_scenes.hpp"
#include "support/cases/placed_scenes.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/surface_interaction.hpp>

#include <array>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

using namespace adversarial;

// The parameter is the instruction set.
class Fronts : public testing::TestWithParam<const Kernels*> {
 protected:
  void SetUp() override { setenv("MICROTRACE_ISA", GetParam()->name, 1); }
  void TearDown() override { unsetenv("MICROTRACE_ISA"); }
};

INSTANTIATE_TEST_SUITE_P(Isa, Fronts, testing::ValuesIn(kRayKernels.available()),
                         [](const auto& isa) { return std::string(isa.param->name); });

/// Rays in columns.
struct Columns {
  std::array<std::vector<float>, 3> o, d;
  std::vector<float> t_max;
  std::vector<PrimitiveId> left;

  void add(const Ray& ray) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      o[axis].push_back(ray.o[static_cast<int>(axis)]);
      d[axis].push_back(ray.d[static_cast<int>(axis)]);
    }
    t_max.push_back(ray.t_max);
    left.push_back(kNoPrimitive);
  }
  [[nodiscard]] RayColumns view() const {
    return {.o = {o[0].data(), o[1].data(), o[2].data()},
            .d = {d[0].data(), d[1].data(), d[2].data()},
            .t_max = t_max.data(),
            .left = left.data(),
            .count = left.size()};
  }
};

PrimitiveSet some_open(Random& random, const Scene& scene, const Bvh& bvh) {
  PrimitiveSet open(bvh.primitives().count(), "triangles");
  for (PrimitiveId id = 0; id < bvh.primitives().count(); ++id) {
    const bool on_mesh = std::holds_alternative<Mesh>(bvh.primitives().object(id).shape);
    if (on_mesh && !random.one_in(4)) open.insert(id, id + 1);
  }
  EXPECT_FALSE(scene.objects.empty());
  return open;
}

TEST_P(Fronts, RaysInColumnsFindTheSame) {
  Random random(31);
  RayTracer tracer;
  std::size_t passed = 0, blocked = 0;
  for (int round = 0; round < 600; ++round) {
    const Scene scene = random_scene(random);
    const Bvh bvh(scene);
    tracer.begin(bvh);
    const PrimitiveSet open = some_open(random, scene, bvh);
    Columns columns;
    for (int i = 0; i < 40; ++i) {
      Ray ray = random_ray(random, scene, origin(random, scene));
      ray.t_min = 0;
      columns.add(ray);
    }
    const RayColumns rays = columns.view();
    std::vector<PrimitiveId> ids(rays.count);
    tracer.closest(rays, {}, ids);
    std::vector<PrimitiveId> any(rays.count), behind(rays.count), first_behind(rays.count);
    tracer.any(rays, {}, any);
    if (tracer.knows_sides()) {
      tracer.any(rays, {.open = {.triangles = open.pages()}}, behind);
      tracer.closest(rays, {.open = {.triangles = open.pages()}}, first_behind);
    }
    for (std::size_t i = 0; i < rays.count; ++i) {
      const Ray ray = rays[i];
      std::optional<Hit> hit = bvh.intersect(ray);
      ASSERT_EQ(ids[i], hit ? hit->id : kNoPrimitive) << "scene " << round << ", ray " << i;
      ASSERT_EQ(any[i] != kNoPrimitive, hit.has_value());
      if (hit) {
        ASSERT_EQ(tracer.hit(ray, ids[i]).t, hit->t);
      }
      if (!tracer.knows_sides()) continue;
      const bool is_hit = hit.has_value();
      const auto is_open = [&](PrimitiveId id) {
        return meets_open_side(bvh.primitives(), {.triangles = open.pages()}, ray, id);
      };
      while (hit && is_open(hit->id)) hit = bvh.next(ray, *hit);
      ASSERT_EQ(behind[i] != kNoPrimitive, hit.has_value()) << "scene " << round << ", ray " << i;
      ASSERT_EQ(first_behind[i], hit ? hit->id : kNoPrimitive)
          << "scene " << round << ", ray " << i;
      if (hit) {
        ASSERT_FALSE(is_open(behind[i]));
      }
      passed += is_hit && !hit ? 1 : 0;
      blocked += hit ? 1 : 0;
    }
  }
  EXPECT_GT(passed, 400U);
  EXPECT_GT(blocked, 2000U);
}

/// True if a ray passes through a masked triangle: a random decision for each pair.
bool passes_at_random(const void* /*context*/, std::size_t i, const Ray& ray, PrimitiveId id) {
  const auto number = static_cast<std::uint32_t>(i * 0x9e3779b9U) ^ (id * 0x85ebca6bU);
  EXPECT_EQ(ray.t_max, static_cast<float>(i + 1));  // the ray's number is right
  return (number * 0xc2b2ae35U >> 30U) != 0;
}

/// What check_weights() needs, and the number of weights that it has checked.
struct Weighed {
  const Primitives& primitives;
  RayColumns rays;
  mutable std::size_t count = 0;
};
/// Checks the weights of a hit, which it leaves to passes_at_random().
Visible check_weights(const void* context, std::size_t i, PrimitiveId id, const HitWeights& at) {
  const auto& weighed = *static_cast<const Weighed*>(context);
  if (!at.are_sure) return Visible::unsure;
  const DVec3 expected =
      interact(weighed.primitives, weighed.rays[i], {.id = id, .t = 0}).triangle->barycentrics;
  EXPECT_NEAR(at.second, expected.y, HitWeights::kError) << "ray " << i << ", primitive " << id;
  EXPECT_NEAR(at.third, expected.z, HitWeights::kError) << "ray " << i << ", primitive " << id;
  ++weighed.count;
  return Visible::unsure;
}

/// Compares queries that pass through random open fronts and masked triangles.
void check_masked(Random& random, RayTracer& tracer, const Scene& scene, std::size_t& passed,
                  std::size_t& found, std::size_t& weighed) {
  const Bvh bvh(scene);
  tracer.begin(bvh);
  const PrimitiveId count = bvh.primitives().count();
  PrimitiveSet open(count, "triangles"), masked(count, "triangles");
  for (PrimitiveId id = 0; id < count; ++id) {
    const bool on_mesh = std::holds_alternative<Mesh>(bvh.primitives().object(id).shape);
    if (on_mesh && random.one_in(2)) masked.insert(id, id + 1);
    if (on_mesh && random.one_in(3)) open.insert(id, id + 1);
  }
  const bool with_open = tracer.knows_sides() && random.one_in(2);
  Columns columns;
  std::vector<float> t_min;
  // More rays than a stream traces at a time.
  const int rays_count = random.one_in(20) ? kStreamRays + 30 : 40;
  for (int i = 0; i < rays_count; ++i) {
    Ray ray = random_ray(random, scene, origin(random, scene));
    ray.t_max = static_cast<float>(i + 1);
    if (!(ray.t_min <= 1)) ray.t_min = 0;
    columns.add(ray);
    t_min.push_back(ray.t_min);
  }
  RayColumns rays = columns.view();
  rays.t_min = t_min.data();
  const Weighed context{.primitives = bvh.primitives(), .rays = rays};
  const HitFilter filter{.open = {.triangles = with_open ? open.pages() : nullptr},
                         .masked = {.triangles = masked.pages(),
                                    .context = &context,
                                    .known = count % 2 == 0 ? check_weights : nullptr,
                                    .passes = passes_at_random}};
  std::vector<PrimitiveId> closest(rays.count), any(rays.count);
  tracer.closest(rays, filter, closest);
  tracer.any(rays, filter, any);
  for (std::size_t i = 0; i < rays.count; ++i) {
    const Ray ray = rays[i];
    const auto passes = [&](PrimitiveId id) {
      return meets_open_side(bvh.primitives(), filter.open, ray, id) ||
             filter.masked.lets_pass(i, ray, id);
    };
    std::optional<Hit> hit = bvh.intersect(ray);
    const bool is_hit = hit.has_value();
    while (hit && passes(hit->id)) hit = bvh.next(ray, *hit);
    ASSERT_EQ(closest[i], hit ? hit->id : kNoPrimitive) << "ray " << i;
    ASSERT_EQ(any[i] != kNoPrimitive, hit.has_value()) << "ray " << i;
    if (hit) {
      ASSERT_FALSE(passes(any[i]));
    }
    passed += is_hit && !hit ? 1 : 0;
    found += hit ? 1 : 0;
  }
  weighed += context.count;
}

TEST_P(Fronts, RaysPassThroughMaskedTriangles) {
  Random random(32);
  RayTracer tracer;
  std::size_t passed = 0, found = 0, weighed = 0;
  for (int round = 0; round < 600; ++round) {
    SCOPED_TRACE("scene " + std::to_string(round));
    check_masked(random, tracer, random_scene(random), passed, found, weighed);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(passed, 400U);
  EXPECT_GT(found, 2000U);
  EXPECT_GT(weighed, 1000U);
}

TEST_P(Fronts, RaysPassThroughMaskedTrianglesOfInstances) {
  Random random(33);
  RayTracer tracer;
  std::size_t passed = 0, found = 0, weighed = 0;
  for (int round = 0; round < 12; ++round) {
    for (const PlacementKind kind : kPlacementKinds) {
      SCOPED_TRACE("scene " + std::to_string(round));
      check_masked(random, tracer, random_placed_scenes(random, kind).instanced, passed, found,
                   weighed);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(passed, 400U);
  EXPECT_GT(found, 2000U);
  EXPECT_GT(weighed, 1000U);
}

}  // namespace
}  // namespace microtrace
