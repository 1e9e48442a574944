// A host's rounding mode and its flushing of subnormal numbers change no answer, and are the host's
// again afterwards.

#include "float_environment.hpp"

#include "support/adversarial_rays.hpp"
#include "support/generated_meshes.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/io.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <cfenv>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

bool is_flushing() {
  volatile float least = std::numeric_limits<float>::denorm_min();
  return least * 1.0F == 0;
}

void flush_subnormals(bool flush) {
#if defined(__x86_64__)
  const std::uint32_t bits = (1U << 6U) | (1U << 15U);
  const std::uint32_t now = __builtin_ia32_stmxcsr();
  __builtin_ia32_ldmxcsr(flush ? now | bits : now & ~bits);
#else
  std::uint64_t now;
  __asm__ volatile("mrs %0, fpcr" : "=r"(now));
  now = flush ? now | (1U << 24U) : now & ~(std::uint64_t{1} << 24U);
  __asm__ volatile("msr fpcr, %0" : : "r"(now));
#endif
}

class HostRules : public testing::TestWithParam<int> {
 protected:
  void set() {
    std::fesetround(GetParam());
    flush_subnormals(true);
  }
  void expect_kept() {
    EXPECT_EQ(std::fegetround(), GetParam());
    EXPECT_TRUE(is_flushing());
  }
  void TearDown() override {
    std::fesetround(FE_TONEAREST);
    flush_subnormals(false);
  }
};

INSTANTIATE_TEST_SUITE_P(Rounding, HostRules,
                         testing::Values(FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO));

std::vector<Vec3> picture(const char* name) {
  const Scene scene = load_scene(std::string(MICROTRACE_SOURCE_DIR "/scenes/").append(name)).scene;
  const Film film = render(scene, scene.cameras[0].camera, scene.size, {.threads = 2});
  std::vector<Vec3> pixels;
  for (std::uint32_t y = 0; y < film.size().height; ++y)
    pixels.insert(pixels.end(), film.row(y).begin(), film.row(y).end());
  return pixels;
}

TEST_P(HostRules, ChangeNoPicture) {
  for (const char* name : {"degenerate/subnormal.json", "perspective1.json", "gltf/knot.glb"}) {
    const std::vector<Vec3> expected = picture(name);
    set();
    const std::vector<Vec3> actual = picture(name);
    expect_kept();
    TearDown();
    EXPECT_TRUE(actual == expected) << name;
  }
}

// A triangle smaller than the least normal number: flushed, it would be a point.
TEST_P(HostRules, ChangeNoHit) {
  constexpr float kLeast = std::numeric_limits<float>::denorm_min();
  Scene scene;
  const Triangle tiny{Vec3(-2 * kLeast, -2 * kLeast, 0), Vec3(3 * kLeast, 0, 0),
                      Vec3(0, 3 * kLeast, 0)};
  for (int i = 0; i < 20; ++i) scene.objects.push_back({.name = "", .shape = tiny});
  const Ray ray{.o = {kLeast, kLeast, 1}, .d = {0, 0, -1}};
  for (const std::size_t count : {std::size_t{1}, std::size_t{20}}) {
    scene.objects.resize(count, {.name = "", .shape = tiny});
    set();
    const Bvh bvh(scene);
    const auto hit = bvh.intersect(ray);
    const bool occluded = bvh.occluded(ray);
    const std::vector<Ray> rays(64, ray);
    std::vector<std::optional<Hit>> hits(64);
    bvh.intersect(rays, hits);
    expect_kept();
    TearDown();
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->id, 0U);
    EXPECT_EQ(hit->t, 1);
    EXPECT_TRUE(occluded);
    EXPECT_TRUE(
        std::all_of(hits.begin(), hits.end(), [](const auto& h) { return h && h->id == 0; }));
  }
}

TEST_P(HostRules, ChangeNoParameter) {
  Scene scene;
  scene.objects.push_back({.name = "", .shape = generated::displaced_sphere(5000)});
  const Bvh bvh(scene);
  adversarial::Random random(5);
  std::vector<Ray> rays(1000);
  for (Ray& ray : rays) ray = {.o = random.in_cube(3), .d = random.in_cube(1)};
  for (std::size_t i = 500; i < 564; ++i) rays[i].o = rays[500].o;  // a tile
  std::vector<std::optional<Hit>> expected(rays.size()), together(rays.size()), singly;
  bvh.intersect(rays, expected);
  set();
  bvh.intersect(rays, together);
  for (const Ray& ray : rays) singly.push_back(bvh.intersect(ray));
  expect_kept();
  TearDown();
  const auto same = [](const std::optional<Hit>& a, const std::optional<Hit>& b) {
    return a.has_value() == b.has_value() && (!a || (a->id == b->id && a->t == b->t));
  };
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), together.begin(), same));
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), singly.begin(), same));
}

}  // namespace
}  // namespace microtrace
