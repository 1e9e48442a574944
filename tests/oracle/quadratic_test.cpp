/// Compares first_hit of planes, discs, spheres and quadrics with CGAL's real roots. Also compares
/// the order of hits of different shapes.

#include "exact/first_hit.hpp"
#include "oracle/real_roots.hpp"
#include "oracle/rounding_check.hpp"
#include "support/cases/adversarial_rays.hpp"
#include "support/effort.hpp"
#include "support/reproduction.hpp"

#include <deque>
#include <optional>

#include <gtest/gtest.h>

namespace microtrace::oracle {
namespace {

using adversarial::ShapeKind;
using exact::first_hit;

/// A hit's parameter: the computed one, and the oracle's.
struct Parameter {
  exact::Root found;
  Real expected;
};

int sign(std::strong_ordering order) {
  return order < 0 ? -1 : order > 0;
}

/// Compares all results for a ray and a shape with the oracle.
class OracleComparison {
 public:
  template <class Shape>
  ::testing::AssertionResult agrees(const Shape& shape, const Ray& ray) {
    ++ray_count_;
    const auto found = first_hit(shape, ray);
    const auto expected = first_parameter(shape, ray);
    if (found.has_value() != expected.has_value()) {
      return ::testing::AssertionFailure() << (found ? "false hit" : "missed");
    }
    if (!found) return ::testing::AssertionSuccess();
    ++hit_count_;
    if (CGAL::compare(to_real(*found), *expected) != 0) {
      return ::testing::AssertionFailure()
             << "t is " << to_real(*found) << ", must be " << *expected;
    }
    if (!is_enclosed(*expected, enclose(*found))) {
      return ::testing::AssertionFailure() << "bounds do not enclose t = " << *expected;
    }
    if (!is_nearest(round_to_float(*found), *expected)) {
      return ::testing::AssertionFailure() << *expected << " rounds to " << round_to_float(*found);
    }
    return orders({*found, *expected});
  }

  [[nodiscard]] int ray_count() const { return ray_count_; }
  [[nodiscard]] int hit_count() const { return hit_count_; }

 private:
  /// Compares the order of a hit and the last few hits of any shape with the oracle.
  ::testing::AssertionResult orders(const Parameter& t) {
    for (const Parameter& other : recent_) {
      if (sign(t.found <=> other.found) != CGAL::compare(t.expected, other.expected)) {
        return ::testing::AssertionFailure()
               << t.expected << " and " << other.expected << " are in the wrong order";
      }
    }
    recent_.push_front(t);
    if (recent_.size() > 4) recent_.pop_back();
    return ::testing::AssertionSuccess();
  }

  std::deque<Parameter> recent_;
  int ray_count_ = 0, hit_count_ = 0;
};

class ShapeKinds : public ::testing::TestWithParam<ShapeKind> {
 protected:
  template <class Shape>
  void check(const adversarial::Case<Shape>& c) {
    ASSERT_TRUE(comparison_.agrees(c.shape, c.ray)) << adversarial::reproduction(c.ray, c.shape);
    const auto hit = first_hit(c.shape, c.ray);
    if (!hit) return;
    const Ray near = adversarial::with_range_near(random_, c.ray, round_to_float(*hit));
    ASSERT_TRUE(comparison_.agrees(c.shape, near)) << adversarial::reproduction(near, c.shape);
  }

  adversarial::Random random_ = announced_random(200 + static_cast<std::uint64_t>(GetParam()));
  OracleComparison comparison_;
};

TEST_P(ShapeKinds, AgreesOnHitParameterAndOrder) {
  const int count = case_count(0.02);
  for (int i = 0; i < count && !HasFatalFailure(); ++i) {
    check(adversarial::plane_case(random_, GetParam()));
    check(adversarial::disc_case(random_, GetParam()));
    check(adversarial::sphere_case(random_, GetParam()));
    check(adversarial::quadric_case(random_, GetParam()));
  }
  EXPECT_GT(comparison_.hit_count(), count / 10) << "too few hits to mean anything";
  announce(comparison_.ray_count(), comparison_.hit_count());
}

INSTANTIATE_TEST_SUITE_P(ShapeOracle, ShapeKinds, ::testing::ValuesIn(adversarial::kShapeKinds),
                         [](const auto& kind) { return adversarial::name(kind.param); });

}  // namespace
}  // namespace microtrace::oracle
