#pragma once
/// The signed volumes of docs/derivations.md in float32, with an error bound derived in
/// docs/exactness.md.

#include "simd/vectors.hpp"

namespace microtrace {
namespace {

constexpr float kUnit = 0x1p-24F;        // unit roundoff of float32
constexpr float kTiny = 0x1p-100F;       // exceeds the total effect of underflow, 2^-107
constexpr float kFarthestHit = 0x1p64F;  // coordinates are at most 2^38 and the largest |d_i| is at
                                         // least 2^-20, so every hit is below 2^60

template <class F>
struct Interval {
  F lo, hi;
};

/// Returns the interval of t = height / size, where size must exceed 16 times its error. Half of
/// the factor 8 in the last term would suffice, because t and its ends have three roundings.
/// Requiring only 8 times the error would suffice too: such small sizes are sums with strong
/// cancellation, for which the errors of size and height are below 13/17 of their bounds.
template <class F, class G, class H>
inline Interval<F> interval(const F& height, const F& size, const G& height_error,
                            const H& size_error) {
  const F inverse = 1 / size, t = height * inverse, distance = t < F{} ? -t : t;
  const F radius =
      (height_error + distance * size_error) * inverse * 1.07F + distance * (8 * kUnit);
  return {t - radius, t + radius};
}

template <int N>
inline Float<N> lanes_of(float x) {
  return all<N>(x);
}
template <int N>
inline Float<N> lanes_of(const Float<N>& x) {
  return x;
}

constexpr float kNoSlack = -0.0F;  // compilers know that x + -0 is x, but not that x + 0 is x

template <class A, class B>
inline auto dot(const A (&a)[3], const B (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/// The signed volumes of N triangles and one ray, or of one triangle and N rays, and bounds of
/// their errors. RayPart is a vector of lanes if there are N rays, otherwise a scalar.
template <int N, class RayPart>
struct Volumes {
  using F = Float<N>;
  F u, v, height;  ///< multiplied by the sign of the volume whose magnitude is `size`
  F size, edge_error, height_error;
  RayPart size_error;

  /// a is the vector from the ray's origin to the first vertex, e1 and e2 are the edges from that
  /// vertex, and n is e1 x e2. em is TriangleBlock::largest_edge, and m is
  /// TriangleBlock::edge_product. `slack` is added to |a| (see InnerRay), and height_slack to the
  /// error of `height`. Always inlined, like BlockTest::run.
  template <class TrianglePart>
  __attribute__((always_inline))
  Volumes(const F (&a)[3], const TrianglePart (&e1)[3], const TrianglePart (&e2)[3],
          const TrianglePart (&n)[3], const RayPart (&d)[3], float em, float m,
          const RayPart& d_sum, float slack, float height_slack) {
    const F r[3] = {a[1] * d[2] - a[2] * d[1], a[2] * d[0] - a[0] * d[2],
                    a[0] * d[1] - a[1] * d[0]};
    const F signed_size = dot(n, d);
    size = magnitude(signed_size);
    u = with_sign_of<N>(dot(e2, r), signed_size);
    v = -with_sign_of<N>(dot(e1, r), signed_size);
    height = with_sign_of<N>(dot(n, a), signed_size);

    const F a_sum = magnitude(a[0]) + magnitude(a[1]) + magnitude(a[2]) + slack;
    edge_error = (a_sum * em + m) * (15.01F * kUnit * d_sum) + kTiny;
    height_error = a_sum * (17.01F * kUnit * m) + (kTiny + height_slack);
    size_error = 15.01F * kUnit * d_sum * m + kTiny;
  }

  /// Returns the lanes in which even the sign of `size` may be wrong.
  [[nodiscard]] Lanes without_sign() const { return less_equal<N>(size, lanes_of<N>(size_error)); }
  /// Returns the lanes in which `size` is large enough for interval().
  [[nodiscard]] Lanes with_t() const { return less<N>(lanes_of<N>(16 * size_error), size); }

  /// Returns the lanes whose t is not certainly outside of [t_begin, t_limit].
  [[nodiscard]] __attribute__((always_inline)) Lanes in_range(const RayPart& t_begin,
                                                              const RayPart& t_limit) const {
    // If signed_size may have the wrong sign, height may too, so the triangle is not certainly
    // behind the ray.
    return less_equal<N>(height - size * t_limit, height_error + size_error * t_limit) &
           (less_equal<N>(size * t_begin - height, height_error + size_error * t_begin) |
            without_sign());
  }
};

/// Tests N triangles against one ray, or one triangle against N rays.
template <int N, class RayPart>
class VolumeTest : public Volumes<N, RayPart> {
 public:
  using F = Float<N>;
  Lanes maybe;    ///< lanes that are not certain misses
  Lanes certain;  ///< lanes of `maybe` that are certain hits

  /// See Volumes. Always inlined, like BlockTest::run.
  template <class TrianglePart>
  __attribute__((always_inline))
  VolumeTest(const F (&a)[3], const TrianglePart (&e1)[3], const TrianglePart (&e2)[3],
             const RayPart (&d)[3], float em, float m, const RayPart& d_sum, const RayPart& t_begin,
             const RayPart& t_limit, float slack = kNoSlack)
      : VolumeTest({a, e1, e2, Cross<TrianglePart>(e1, e2).n, d, em, m, d_sum, slack, kNoSlack},
                   t_begin, t_limit) {}

 private:
  using Base = Volumes<N, RayPart>;

  template <class Part>
  struct Cross {
    Part n[3];
    __attribute__((always_inline)) Cross(const Part (&a)[3], const Part (&b)[3])
        : n{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]} {}
  };

  __attribute__((always_inline))
  VolumeTest(const Base& volumes, const RayPart& t_begin, const RayPart& t_limit)
      : Base(volumes) {
    // Positive if the ray passes inside all three edges, negative outside.
    const F within = lesser(lesser(this->u, this->v), this->size - (this->u + this->v));
    maybe = less_equal<N>(-this->edge_error, within) & this->in_range(t_begin, t_limit);
    certain = maybe & less<N>(this->edge_error, within) & this->with_t();
  }
};

}  // namespace
}  // namespace microtrace
