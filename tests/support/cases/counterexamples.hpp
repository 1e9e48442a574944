#pragma once
/// Rays and triangles for which well-known float32 tests give the wrong result.

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <array>
#include <limits>

namespace microtrace::adversarial {

struct Counterexample {
  const char* name;
  Ray ray;
  Triangle triangle;
  bool hit;  ///< the exact result
};

[[nodiscard]] inline Ray from_zero(const Vec3& o, const Vec3& d) {
  return {.o = o, .t_min = 0, .d = d, .t_max = std::numeric_limits<float>::infinity()};
}

inline const std::array<Counterexample, 7> counterexamples{{
    {"missed by Moeller-Trumbore in float32",
     from_zero({-2, 2, 3}, {0, -2, -7.5f}),
     {{-3, 3, 2}, {-2, 2, 2}, {-2, -2, 0}},
     true},
    {"missed by Moeller-Trumbore in float64",
     from_zero({1, -3, 0}, {-3, 35, 0}),
     {{0, -4, 3}, {0, 4, 0}, {4, 4, 0}},
     true},
    {"missed by Woop's watertight test and by pbrt's",
     from_zero({-1, -1, 4}, {2, 1, -5.5f}),
     {{3, -2, -2}, {-4, -2, 5}, {-1, 2, -1}},
     true},
    {"missed by Embree's fast test",
     from_zero({1, 132, -129}, {-156, -43.5f, 247.5f}),
     {{60, -128, -55}, {-162, 87, 172}, {-148, 90, 65}},
     true},
    {"missed by Embree's robust test",
     from_zero({95, -85, -130}, {-35.75f, 159, 166.25f}),
     {{-138, 44, -134}, {125, 84, 93}, {20, 57, -21}},
     true},
    {"a false hit of Moeller-Trumbore in float32 and of Embree's robust test",
     from_zero({125, -999, 1357}, {-38, -672, -1948}),
     {{1855, -1089, -1729}, {87, -1672, -591}, {127, 661, 1456}},
     false},
    {"a false hit of CGAL 5.5's intersection(Triangle_3, Ray_3): coplanar, pointing away",
     from_zero({-2, 4, -1}, {0, 2, -2}),
     {{-2, -2, -7}, {-2, 1, 2}, {-2, 3, 0}},
     false},
}};

}  // namespace microtrace::adversarial
