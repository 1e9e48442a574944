#pragma once
/// Rays and shapes that are difficult for rounded arithmetic: rays through vertices and along
/// edges, origins on surfaces, tangent rays, degenerate shapes, and all magnitudes of float32. A
/// seed gives the same cases on every machine.

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <array>
#include <cstdint>

namespace microtrace::adversarial {

/// xorshift64* (Vigna, "An experimental exploration of Marsaglia's xorshift generators, scrambled",
/// 2016).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}

  std::uint32_t bits();
  /// Returns a random integer in [lo, hi].
  int between(int lo, int hi);
  bool one_in(int n) { return between(1, n) == 1; }
  /// Returns a random number in [0, 1).
  double unit();
  /// Returns a random number in [-1, 1].
  float symmetric() { return static_cast<float>(2 * unit() - 1); }
  /// Returns 2^k for a random integer k in [lo, hi].
  float power_of_two(int lo, int hi);
  /// Returns a number with a random sign, an exponent in [lo, hi] and a random mantissa that
  /// sometimes has few bits.
  float any_float(int lo, int hi);
  Vec3 any_vector(int lo, int hi);
  /// Returns a random point in the cube [-half_width, half_width]^3.
  Vec3 in_cube(float half_width);
  /// Returns a point whose coordinates are random integers from -n to n, multiplied by the spacing.
  Vec3 on_grid(int n, float spacing = 1);
  /// Returns v with each coordinate moved by up to n units in the last place.
  Vec3 jitter(const Vec3& v, int n);

 private:
  std::uint64_t state_;
};

/// Moves x by n units in the last place. Leaves x unchanged if it is near zero or the largest
/// number.
[[nodiscard]] float moved(float x, int n);

/// An origin and a direction. Compilers may evaluate function arguments in any order, but must
/// evaluate initializer lists from left to right. Expressions that draw several random numbers are
/// therefore initializer lists, which give the same cases with every compiler.
struct Line {
  Vec3 o, d;
};

/// Returns the ray along the line over the interval [0, infinity].
[[nodiscard]] Ray ray(const Line& line);

template <class S>
struct Case {
  Ray ray;
  S shape;
};

enum class TriangleKind {
  unit,             ///< vertices in a unit cube, half of the rays aimed at a point of the triangle
  grid,             ///< small integers times a power of two
  vertex,           ///< aimed at a vertex, with an error of up to 3 ulps
  edge,             ///< aimed at a point of an edge, exactly in half of the cases
  origin_on_plane,  ///< origin at a vertex or within 2 ulps of the plane
  far_from_zero,    ///< up to 2^24 triangle sizes away from (0, 0, 0)
  full_range,       ///< every exponent of float32
  subnormal,
  coplanar,      ///< the ray in the triangle's plane or an ulp away from it
  degenerate,    ///< collinear or equal vertices
  sliver,        ///< heights down to 2^-26 of the length
  axis_aligned,  ///< integer coordinates, d along an axis
};

inline constexpr std::array kTriangleKinds = {TriangleKind::unit,
                                              TriangleKind::grid,
                                              TriangleKind::vertex,
                                              TriangleKind::edge,
                                              TriangleKind::origin_on_plane,
                                              TriangleKind::far_from_zero,
                                              TriangleKind::full_range,
                                              TriangleKind::subnormal,
                                              TriangleKind::coplanar,
                                              TriangleKind::degenerate,
                                              TriangleKind::sliver,
                                              TriangleKind::axis_aligned};

[[nodiscard]] const char* name(TriangleKind kind);
[[nodiscard]] Case<Triangle> triangle_case(Random& random, TriangleKind kind);

/// Kinds of cases for planes, discs, spheres and quadrics.
enum class ShapeKind {
  random,
  grid,          ///< small integers times a power of two
  tangent,       ///< touches the surface; planes: parallel up to an ulp; discs: through the rim
  on_surface,    ///< origin exactly on the surface
  axis_aligned,  ///< integer coordinates, d along an axis
  full_range,    ///< every exponent of float32
  subnormal,
  special,  ///< planes, discs: the ray in the plane; spheres: radius 0; quadrics: no t^2 term
};

inline constexpr std::array kShapeKinds = {
    ShapeKind::random,       ShapeKind::grid,       ShapeKind::tangent,   ShapeKind::on_surface,
    ShapeKind::axis_aligned, ShapeKind::full_range, ShapeKind::subnormal, ShapeKind::special};

[[nodiscard]] const char* name(ShapeKind kind);
[[nodiscard]] Case<Plane> plane_case(Random& random, ShapeKind kind);
[[nodiscard]] Case<Disc> disc_case(Random& random, ShapeKind kind);
[[nodiscard]] Case<Sphere> sphere_case(Random& random, ShapeKind kind);
[[nodiscard]] Case<Quadric> quadric_case(Random& random, ShapeKind kind);

/// Returns the ray with t_min, t_max or both moved to t or to a neighboring number.
[[nodiscard]] Ray with_range_near(Random& random, Ray ray, float t);

}  // namespace microtrace::adversarial
