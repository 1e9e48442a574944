#pragma once
#include "accel/filters/filter.hpp"

#include <microtrace/shape.hpp>

#include <glm/geometric.hpp>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Returns the first of the two roots (-b -+ s) / a that is in range, where a is certainly positive
/// and s is the square root of the discriminant. The roots are tested in ascending order. A root
/// that is certainly in range is a hit; a root that may be in range makes the result unsure.
template <int N>
[[nodiscard]] inline FilterResults<N> first_root_result(const Approximates<N>& a,
                                                        const Approximates<N>& b,
                                                        const Approximates<N>& s,
                                                        const Ranges<N>& range) {
  const Double<N> error = b.error + s.error + gamma(1) * (magnitude(b.value) + s.value);
  const FilterResults<N> near =
      quotient_result<N>({.value = -b.value - s.value, .error = error}, a, range);
  if (!any(near.miss)) return near;
  const FilterResults<N> far =
      quotient_result<N>({.value = -b.value + s.value, .error = error}, a, range);
  return {.miss = near.miss & far.miss,
          .hit = near.hit | (near.miss & far.hit),
          .lo = near.miss ? far.lo : near.lo,
          .hi = near.miss ? far.hi : near.hi};
}

/// Returns the square root of a number that is certainly positive: |sqrt(x) - sqrt(x*)| <= error /
/// sqrt(x) if error <= x. Callers make sure that x exceeds four times its error. gamma(2) would
/// suffice, because there are two roundings of second order.
template <int N>
[[nodiscard]] inline Approximates<N> square_root(const Approximates<N>& x) {
  const Double<N> root = square_root<N>(x.value);
  return {.value = root, .error = x.error / root * (1 + gamma(4)) + gamma(1) * root};
}

/// Returns the results for roots that exist where `is_sure` is true, and that certainly don't exist
/// where `misses` is.
template <int N>
[[nodiscard]] inline FilterResults<N> results_where(const RayMask<N>& is_sure,
                                                    const RayMask<N>& misses,
                                                    const FilterResults<N>& roots) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Double<N> none{};
  const RayMask<N> has_roots = is_sure & negated(misses);
  return {.miss = misses | (has_roots & roots.miss),
          .hit = has_roots & roots.hit,
          .lo = has_roots ? roots.lo : none - kInfinity,
          .hi = has_roots ? roots.hi : none + kInfinity};
}

/// A sphere relative to the ray origin o. With m = o - center, hits satisfy (d.d) t^2 + 2 (d.m) t +
/// m.m - r^2 = 0. The discriminant (d.m)^2 - (d.d)(m.m - r^2) would suffer from cancellation. By
/// Lagrange's identity it equals r^2 d.d - |d x m|^2, which is computed instead.
[[nodiscard]] inline SeenSphere sphere_seen_from(const Vec3& o, const Sphere& sphere) {
  const DVec3 m = DVec3(o) - DVec3(sphere.center);
  const double m2 = glm::dot(m, m), radius2 = double{sphere.radius} * sphere.radius;
  // Only the sign of `outside` is used. The five roundings are two of m, one of the squares, and
  // two of their sum.
  return {.m = m,
          .radius2 = radius2,
          .outside = {.value = m2 - radius2, .error = gamma(5) * m2 + kUnderflow}};
}

template <int N = 1>
[[nodiscard]] inline FilterResults<N> filter(const SeenSphere& sphere, const Doubles3<N>& d,
                                             const Ranges<N>& range) {
  // A component v of d x m has the roundings of m, of the products and of the difference. If p is
  // its permanent, |v - v*| <= u (2 p + |v|), so |v^2 - v*^2| <= u (4 |v| p + 2 v^2) + u^2 (2 p +
  // |v|)^2. The sum of v^2 adds three roundings, d^2 r^2 has three, and the difference adds one.
  // The total error is at most u (4 |v| p + 6 v^2 + 4 d^2 r^2), where v^2 <= |v| p. The
  // second-order term matters if v vanishes but v* does not: then v*^2 <= 4 u^2 p^2. Even u^2 p^2
  // instead of gamma(4)^2 p^2 would suffice, because a hit is certain only above four errors.
  const Doubles3<N> m = all_lanes<N>(sphere.m);
  const Doubles3<N> left{d.y * m.z, d.z * m.x, d.x * m.y}, right{d.z * m.y, d.x * m.z, d.y * m.x};
  const Doubles3<N> v = left - right, p = magnitudes(left) + magnitudes(right);
  const Double<N> v2 = dot(v, v), d2 = dot(d, d), rd2 = sphere.radius2 * d2;
  const Approximates<N> discriminant = {.value = rd2 - v2,
                                        .error = gamma(5) * (dot(magnitudes(v), p) + v2 + rd2) +
                                                 gamma(4) * gamma(4) * dot(p, p) + kUnderflow};
  RayMask<N> misses = discriminant.is_negative();
  if (are_all(misses)) return results_where<N>(RayMask<N>{}, misses, FilterResults<N>{});
  const Approximates<N> b = dot_product<N>(d, m, 4);
  misses |= b.is_positive() & all_rays<N>(sphere.outside).is_positive();
  const RayMask<N> is_sure = discriminant.value > 4 * discriminant.error;
  if (!any(is_sure & negated(misses))) return results_where<N>(is_sure, misses, FilterResults<N>{});
  // The squares in d2 are exact, because d has float32 components.
  return results_where<N>(is_sure, misses,
                          first_root_result<N>({.value = d2, .error = gamma(2) * d2 + kUnderflow},
                                               b, square_root<N>(discriminant), range));
}

/// a x^2 + b y^2 + c z^2 + d xy + e xz + f yz
template <int N = 1>
[[nodiscard]] inline Double<N> quadratic_form(const DVec3& square, const DVec3& mix,
                                              const Doubles3<N>& p) {
  return square.x * p.x * p.x + square.y * p.y * p.y + square.z * p.z * p.z + mix.z * p.x * p.y +
         mix.y * p.x * p.z + mix.x * p.y * p.z;
}

/// Products of two float32 numbers are exact, and products of three have one rounding. The form of
/// degree two adds five sums: six roundings for alpha. The value Q(o) adds two more sums: eight
/// roundings. beta has six roundings: three sums in the gradient, one product and two sums.
inline constexpr int kQuadricRoundings = 8;

/// A quadric Q(p) = 0 relative to the ray origin o: Q(o + t d) = alpha t^2 + (grad Q(o) . d) t +
/// Q(o).
[[nodiscard]] inline SeenQuadric quadric_seen_from(const Vec3& origin, const Quadric& q) {
  const DVec3 squares(q.a, q.b, q.c), mixed(q.f, q.e, q.d);
  const DVec3 o = origin, linear(q.g, q.h, q.i), magnitude = glm::abs(o);
  const auto gradient = [&](const DVec3& square, const DVec3& mix, const DVec3& line,
                            const DVec3& p) {
    return DVec3(2 * square.x * p.x + mix.z * p.y + mix.y * p.z + line.x,
                 2 * square.y * p.y + mix.z * p.x + mix.x * p.z + line.y,
                 2 * square.z * p.z + mix.y * p.x + mix.x * p.y + line.z);
  };
  return {.squares = squares,
          .mixed = mixed,
          .squares_size = glm::abs(squares),
          .mixed_size = glm::abs(mixed),
          .gradient = gradient(squares, mixed, linear, o),
          .gradient_permanent =
              gradient(glm::abs(squares), glm::abs(mixed), glm::abs(linear), magnitude),
          .value = {.value = quadratic_form(squares, mixed, o) + glm::dot(linear, o) + double{q.j},
                    .error = gamma(kQuadricRoundings) *
                                 (quadratic_form(glm::abs(squares), glm::abs(mixed), magnitude) +
                                  glm::dot(glm::abs(linear), magnitude) + std::abs(q.j)) +
                             kUnderflow}};
}

template <int N = 1>
[[nodiscard]] inline FilterResults<N> filter(const SeenQuadric& q, const Doubles3<N>& d,
                                             const Ranges<N>& range) {
  const Doubles3<N> size = magnitudes(d);
  Approximates<N> alpha = {
      .value = quadratic_form<N>(q.squares, q.mixed, d),
      .error = gamma(kQuadricRoundings) * quadratic_form<N>(q.squares_size, q.mixed_size, size) +
               kUnderflow};
  // beta is half of the coefficient of t.
  Approximates<N> beta = {
      .value = dot(all_lanes<N>(q.gradient), d) / 2,
      .error = gamma(kQuadricRoundings) * dot(all_lanes<N>(q.gradient_permanent), size) / 2 +
               kUnderflow};
  const Approximates<N> value = all_rays<N>(q.value);
  const Double<N> b2 = beta.value * beta.value, ac = alpha.value * value.value;
  // The error bounds of beta and alpha count more roundings than there are, so they also cover the
  // roundings of the products and of the difference. The roundings of the bound itself are of
  // second order, for which 1 + gamma(8) would suffice.
  const Approximates<N> discriminant = {
      .value = b2 - ac,
      .error = ((2 * magnitude(beta.value) + beta.error) * beta.error +
                magnitude(alpha.value) * value.error + magnitude(value.value) * alpha.error +
                alpha.error * value.error) *
                   (1 + gamma(16)) +
               kUnderflow};
  const RayMask<N> misses = discriminant.is_negative();
  if (are_all(misses)) return results_where<N>(RayMask<N>{}, misses, FilterResults<N>{});
  const RayMask<N> is_sure = discriminant.value > 4 * discriminant.error;
  const RayMask<N> descends = alpha.is_negative();
  alpha.value = descends ? -alpha.value : alpha.value;
  beta.value = descends ? -beta.value : beta.value;
  return results_where<N>(is_sure, misses,
                          first_root_result<N>(alpha, beta, square_root<N>(discriminant), range));
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
