// Compares the queries of RayTracer for rays in columns with Bvh::intersect and Bvh::next, ray by
// ray, for every instruction set of the machine.

#include "accel/kernels/dispatch.hpp"
#include "accel/ray_tracer.hpp"
#include "support/cases/adversarial_scenes.hpp"

#include <microtrace/bvh.hpp>

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

std::vector<std::uint32_t> some_open(Random& random, const Scene& scene, const Bvh& bvh) {
  std::vector<std::uint32_t> open(bvh.primitives().count() / 32 + 1);
  for (PrimitiveId id = 0; id < bvh.primitives().count(); ++id) {
    const bool on_mesh = std::holds_alternative<Mesh>(bvh.primitives().object(id).shape);
    if (on_mesh && !random.one_in(4)) open[id / 32] |= 1U << id % 32;
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
    const std::vector<std::uint32_t> open = some_open(random, scene, bvh);
    Columns columns;
    for (int i = 0; i < 40; ++i) {
      Ray ray = random_ray(random, scene, origin(random, scene));
      ray.t_min = 0;
      columns.add(ray);
    }
    const RayColumns rays = columns.view();
    std::vector<PrimitiveId> ids(rays.count);
    tracer.closest(rays, nullptr, ids);
    std::vector<PrimitiveId> any(rays.count), behind(rays.count), first_behind(rays.count);
    tracer.any(rays, nullptr, any);
    if (tracer.knows_fronts()) {
      tracer.any(rays, open.data(), behind);
      tracer.closest(rays, open.data(), first_behind);
    }
    for (std::size_t i = 0; i < rays.count; ++i) {
      const Ray ray = rays[i];
      std::optional<Hit> hit = bvh.intersect(ray);
      ASSERT_EQ(ids[i], hit ? hit->id : kNoPrimitive) << "scene " << round << ", ray " << i;
      ASSERT_EQ(any[i] != kNoPrimitive, hit.has_value());
      if (hit) {
        ASSERT_EQ(tracer.hit(ray, ids[i]).t, hit->t);
      }
      if (!tracer.knows_fronts()) continue;
      const bool is_hit = hit.has_value();
      const auto is_open = [&](PrimitiveId id) {
        return meets_open_front(bvh.primitives(), open.data(), ray, id);
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

}  // namespace
}  // namespace microtrace
