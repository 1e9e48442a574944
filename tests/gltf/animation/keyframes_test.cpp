#include "io/gltf/animation/keyframes.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

namespace microtrace::io::gltf {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

Keyframes keys(Interpolation interpolation, std::vector<float> times, std::vector<float> values,
               std::size_t width = 1) {
  return {.interpolation = interpolation,
          .width = width,
          .times = std::make_shared<const std::vector<float>>(std::move(times)),
          .values = std::make_shared<const std::vector<float>>(std::move(values))};
}

Quaternion about_z(double angle) {
  return {0, 0, std::sin(angle / 2), std::cos(angle / 2)};
}

double distance(const Quaternion& a, const Quaternion& b) {
  return glm::length(a - b);
}

TEST(GltfKeyframes, StepsHoldUntilTheNextKey) {
  const Keyframes step = keys(Interpolation::step, {1, 2, 4}, {10, 20, 40});
  EXPECT_THAT(value_at(step, 1), ElementsAre(10));
  EXPECT_THAT(value_at(step, 1.999999), ElementsAre(10));
  EXPECT_THAT(value_at(step, 2), ElementsAre(20));
  EXPECT_THAT(value_at(step, 3.5), ElementsAre(20));
  for (const float fps : {23.976F, 24.0F, 25.0F, 30.0F, 60.0F}) {
    std::vector<float> times, values;
    for (int frame = 0; frame < 1000; ++frame) {
      times.push_back(static_cast<float>(frame) / fps);
      values.push_back(static_cast<float>(frame));
    }
    const Keyframes frames = keys(Interpolation::step, times, values);
    for (int frame = 0; frame < 1000; ++frame)
      EXPECT_THAT(value_at(frames, frame / double{fps}), ElementsAre(frame)) << fps;
  }
  EXPECT_THAT(value_at(step, 4), ElementsAre(40));
}

TEST(GltfKeyframes, LinearInterpolatesEachNumber) {
  const Keyframes linear = keys(Interpolation::linear, {1, 2, 4}, {0, 8, 10, 16, 30, -16}, 2);
  EXPECT_THAT(value_at(linear, 1.25), ElementsAre(2.5, 10));
  EXPECT_THAT(value_at(linear, 2), ElementsAre(10, 16));
  EXPECT_THAT(value_at(linear, 3), ElementsAre(20, 0));
}

TEST(GltfKeyframes, TimesAreClampedToTheKeys) {
  for (const Interpolation kind : {Interpolation::step, Interpolation::linear}) {
    const Keyframes sampler = keys(kind, {1, 2}, {10, 20});
    EXPECT_THAT(value_at(sampler, -5), ElementsAre(10));
    EXPECT_THAT(value_at(sampler, 0), ElementsAre(10));
    EXPECT_THAT(value_at(sampler, 2.5), ElementsAre(20));
    EXPECT_THAT(value_at(sampler, 1e300), ElementsAre(20));
    EXPECT_THAT(value_at(sampler, HUGE_VAL), ElementsAre(20));
  }
  // The in-tangent of the first key and the out-tangent of the last key have no effect.
  const Keyframes cubic = keys(Interpolation::cubic_spline, {1, 2}, {9, 10, 9, 9, 20, 9});
  EXPECT_THAT(value_at(cubic, 0.5), ElementsAre(10));
  EXPECT_THAT(value_at(cubic, 7), ElementsAre(20));
  const Keyframes one = keys(Interpolation::cubic_spline, {3}, {9, 10, 9});
  EXPECT_THAT(value_at(one, 3), ElementsAre(10));
}

TEST(GltfKeyframes, CubicSplinesReproduceAPolynomial) {
  // The keys at 1, 3 and 3.5 seconds have the values of p(t) = 2 t^3 - 3 t^2 + t - 5 and its
  // derivatives per second.
  const auto p = [](double t) { return ((2 * t - 3) * t + 1) * t - 5; };
  const auto slope = [](double t) { return (6 * t - 6) * t + 1; };
  std::vector<float> values;
  for (const double t : {1.0, 3.0, 3.5}) {
    for (const double v : {slope(t), p(t), slope(t)}) values.push_back(static_cast<float>(v));
  }
  const Keyframes cubic = keys(Interpolation::cubic_spline, {1, 3, 3.5F}, values);
  for (double t = 1; t <= 3.5; t += 0.03125) {
    EXPECT_THAT(value_at(cubic, t), ElementsAre(DoubleNear(p(t), 1e-12))) << t;
  }
}

TEST(GltfKeyframes, RotationsHaveConstantSpeed) {
  constexpr double kAngle = 2.5;
  const Quaternion a = about_z(0.3), b = about_z(0.3 + kAngle);
  for (double t = 0; t <= 1; t += 0.0625) {
    EXPECT_LT(distance(slerp(a, b, t), about_z(0.3 + t * kAngle)), 1e-15) << t;
  }
}

TEST(GltfKeyframes, RotationsTakeTheShorterArc) {
  const Quaternion a = about_z(0), b = about_z(0.5);
  EXPECT_LT(distance(slerp(a, -b, 0.5), about_z(0.25)), 1e-15);
  // A rotation by 270 degrees is shorter in the other direction.
  const Quaternion c = about_z(1.5 * std::numbers::pi);
  EXPECT_LT(distance(slerp(a, c, 0.5), about_z(-0.25 * std::numbers::pi)), 1e-15);
}

TEST(GltfKeyframes, SlerpGivesUnitQuaternionsAndIsAccurateAtSmallAngles) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> number;
  for (int i = 0; i < 20000; ++i) {
    const auto any = [&] {
      return unit_quaternion({number(random), number(random), number(random), number(random)});
    };
    const Quaternion a = any();
    const double nearness = std::pow(10.0, -(i % 20));
    const Quaternion b = unit_quaternion(a * (1 - nearness) + any() * nearness);
    const double t = 0.05 * (i % 21);
    const Quaternion q = slerp(a, b, t);
    ASSERT_NEAR(glm::length(q), 1, 1e-14);
    // The angle from a must be t times the angle from a to b. The test compares chord lengths,
    // which are more accurate than angles.
    const double whole =
        std::asin(std::min(1.0, glm::length(glm::dot(a, b) < 0 ? a + b : a - b) / 2));
    ASSERT_NEAR(glm::length(q - a), 2 * std::sin(t * whole), 2e-15);
  }
  EXPECT_EQ(slerp({0, 0, 0, 1}, {0, 0, 0, 1}, 0.25), Quaternion(0, 0, 0, 1));
  EXPECT_EQ(slerp({0, 0, 0, 1}, {0, 0, 0, -1}, 0.25), Quaternion(0, 0, 0, 1));
}

TEST(GltfKeyframes, RotationsAreNormalized) {
  Keyframes turn = keys(Interpolation::linear, {0, 1}, {0, 0, 0, 2, 0, 0, 3, 3}, 4);
  turn.are_rotations = true;
  const double angle = std::numbers::pi / 2;
  EXPECT_THAT(value_at(turn, 0), ElementsAre(0, 0, 0, 1));
  EXPECT_THAT(value_at(turn, 0.5), ElementsAre(0, 0, DoubleNear(std::sin(angle / 4), 1e-15),
                                               DoubleNear(std::cos(angle / 4), 1e-15)));
  // Between the keys, the cubic spline leaves the unit sphere.
  turn = keys(Interpolation::cubic_spline, {0, 1},
              {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}, 4);
  turn.are_rotations = true;
  EXPECT_THAT(value_at(turn, 0.5), ElementsAre(0, 0, DoubleNear(std::sqrt(0.5), 1e-15),
                                               DoubleNear(std::sqrt(0.5), 1e-15)));
}

}  // namespace
}  // namespace microtrace::io::gltf
