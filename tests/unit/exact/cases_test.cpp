#include "support/cases/adversarial_rays.hpp"

#include <bit>

#include <gtest/gtest.h>

namespace microtrace::adversarial {
namespace {

/// FNV-1a hash of the bits of float32 numbers.
class Hash {
 public:
  void add(float x) { state_ = (state_ ^ std::bit_cast<std::uint32_t>(x)) * 0x100000001b3u; }
  void add(const Vec3& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  void add(const Ray& ray) {
    add(ray.o);
    add(ray.d);
    add(ray.t_min);
    add(ray.t_max);
  }
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

TEST(AdversarialRays, TrianglesDoNotDependOnTheCompiler) {
  Random random(1);
  Hash hash;
  for (const TriangleKind kind : kTriangleKinds) {
    for (int i = 0; i < 1000; ++i) {
      const auto [ray, t] = triangle_case(random, kind);
      hash.add(with_range_near(random, ray, 1.5f));
      hash.add(t.a);
      hash.add(t.b);
      hash.add(t.c);
    }
  }
  EXPECT_EQ(hash.value(), 16659916225288092172u);
}

TEST(AdversarialRays, OtherShapesDoNotDependOnTheCompiler) {
  Random random(1);
  Hash hash;
  for (const ShapeKind kind : kShapeKinds) {
    for (int i = 0; i < 1000; ++i) {
      const auto plane = plane_case(random, kind);
      hash.add(plane.ray);
      hash.add(plane.shape.point);
      hash.add(plane.shape.normal);
      const auto disc = disc_case(random, kind);
      hash.add(disc.ray);
      hash.add(disc.shape.normal);
      hash.add(disc.shape.radius);
      const auto sphere = sphere_case(random, kind);
      hash.add(sphere.ray);
      hash.add(sphere.shape.center);
      const auto [ray, q] = quadric_case(random, kind);
      hash.add(ray);
      for (const float x : {q.a, q.b, q.c, q.d, q.e, q.f, q.g, q.h, q.i, q.j}) hash.add(x);
    }
  }
  EXPECT_EQ(hash.value(), 7220535527493158203u);
}

}  // namespace
}  // namespace microtrace::adversarial
