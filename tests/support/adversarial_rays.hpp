#pragma once
/// Rays and shapes that are difficult for rounded arithmetic: rays through vertices and along
/// edges, origins on surfaces, tangents, degenerate shapes, all magnitudes of float32. A seed gives
/// the same cases on every machine.

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
  /// An integer in [lo, hi].
  int between(int lo, int hi);
  bool one_in(int n) { return between(1, n) == 1; }
  /// A number in [0, 1).
  double unit();
  /// A number in [-1, 1].
  float symmetric() { return static_cast<float>(2 * unit() - 1); }
  /// 2^k with k in [lo, hi].
  float power_of_two(int lo, int hi);
  /// A number with random sign, exponent in [lo, hi] and random mantissa, sometimes with few bits.
  float any_float(int lo, int hi);
  Vec3 any_vector(int lo, int hi);
  /// A point in the cube [-half_width, half_width]^3.
  Vec3 in_cube(float half_width);
  /// A point whose coordinates are integers from -n to n times the spacing.
  Vec3 on_grid(int n, float spacing = 1);
  /// The vector with each coordinate moved by up to n units in the last place.
  Vec3 jitter(const Vec3& v, int n);

 private:
  std::uint64_t state_;
};

/// x moved by n units in the last place; x itself if it is near zero or the largest number.
[[nodiscard]] float moved(float x, int n);

/// An origin and a direction. Initializer lists are evaluated from left to right, but function
/// arguments in any order; expressions that draw several random numbers are therefore in lists, so
/// that every compiler draws the same.
struct Line {
  Vec3 o, d;
};

/// The ray along the line with the interval [0, infinity].
[[nodiscard]] Ray ray(const Line& line);

template <class S>
struct Case {
  Ray ray;
  S shape;
};

enum class TriangleKind {
  unit,             ///< vertices in a unit cube, half of the rays aimed at a point inside
  grid,             ///< small integers times a power of two
  vertex,           ///< aimed at a vertex, up to 3 ulps beside it
  edge,             ///< aimed at a point of an edge, half of them exactly
  origin_on_plane,  ///< origin at a vertex or within 2 ulps of the plane
  far_from_zero,    ///< up to 2^24 triangle sizes away from (0, 0, 0)
  full_range,       ///< every exponent of float32
  subnormal,
  coplanar,      ///< the ray in the triangle's plane or an ulp beside it
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

/// Kinds of plane, disc, sphere and quadric cases.
enum class ShapeKind {
  random,
  grid,        ///< small integers times a power of two
  tangent,     ///< touches the surface; planes: parallel except for an ulp; discs: through the rim
  on_surface,  ///< origin exactly on the surface
  axis_aligned,  ///< integer coordinates, d along an axis
  full_range,    ///< every exponent of float32
  subnormal,
  special,  ///< planes, discs: the ray in the plane; spheres: radius 0; quadrics: the t^2
            ///< coefficient vanishes
};

inline constexpr std::array kShapeKinds = {
    ShapeKind::random,       ShapeKind::grid,       ShapeKind::tangent,   ShapeKind::on_surface,
    ShapeKind::axis_aligned, ShapeKind::full_range, ShapeKind::subnormal, ShapeKind::special};

[[nodiscard]] const char* name(ShapeKind kind);
[[nodiscard]] Case<Plane> plane_case(Random& random, ShapeKind kind);
[[nodiscard]] Case<Disc> disc_case(Random& random, ShapeKind kind);
[[nodiscard]] Case<Sphere> sphere_case(Random& random, ShapeKind kind);
[[nodiscard]] Case<Quadric> quadric_case(Random& random, ShapeKind kind);

/// The ray with t_min or t_max, or both, at t or one ulp away.
[[nodiscard]] Ray with_range_near(Random& random, Ray ray, float t);

}  // namespace microtrace::adversarial
