#pragma once
#include "accel/filters/filter.hpp"

#include <microtrace/shape.hpp>

#include <glm/geometric.hpp>

namespace microtrace {

/// Returns the first of the two roots (-b -+ s) / a that is in range, where a is certainly positive
/// and s is the square root of the discriminant. The roots are tested in ascending order. A root
/// that is certainly in range is a hit; a root that may be in range makes the result unsure.
[[nodiscard]] inline FilterResult first_root_result(const Approximate& a, const Approximate& b,
                                                    const Approximate& s, const Range& range) {
  const double error = b.error + s.error + gamma(1) * (std::abs(b.value) + s.value);
  const FilterResult near =
      quotient_result({.value = -b.value - s.value, .error = error}, a, range);
  if (near.certainty != Certainty::miss) return near;
  return quotient_result({.value = -b.value + s.value, .error = error}, a, range);
}

/// Returns the square root of a number that is certainly positive: |sqrt(x) - sqrt(x*)| <= error /
/// sqrt(x) if error <= x. Callers make sure that x exceeds four times its error. gamma(2) would
/// suffice, because there are two roundings of second order.
[[nodiscard]] inline Approximate square_root(const Approximate& x) {
  const double root = std::sqrt(x.value);
  return {.value = root, .error = x.error / root * (1 + gamma(4)) + gamma(1) * root};
}

/// A sphere relative to the ray origin o. With m = o - center, hits satisfy (d.d) t^2 + 2 (d.m) t +
/// m.m - r^2 = 0. The discriminant (d.m)^2 - (d.d)(m.m - r^2) would suffer from cancellation. By
/// Lagrange's identity it equals r^2 d.d - |d x m|^2, which is computed instead.
class SphereFilter {
 public:
  SphereFilter(const Sphere& sphere, const Vec3& o)
      : m_(DVec3(o) - DVec3(sphere.center)), radius2_(double{sphere.radius} * sphere.radius) {
    const double m2 = glm::dot(m_, m_);
    // Only the sign of outside_ is used. The five roundings are two of m, one of the squares, and
    // two of their sum.
    outside_ = {.value = m2 - radius2_, .error = gamma(5) * m2 + kUnderflow};
  }

  [[nodiscard]] FilterResult operator()(const DVec3& d, const Range& range) const {
    // A component v of d x m has the roundings of m, of the products and of the difference. If p is
    // its permanent, |v - v*| <= u (2 p + |v|), so |v^2 - v*^2| <= u (4 |v| p + 2 v^2) + u^2 (2 p +
    // |v|)^2. The sum of v^2 adds three roundings, d^2 r^2 has three, and the difference adds one.
    // The total error is at most u (4 |v| p + 6 v^2 + 4 d^2 r^2), where v^2 <= |v| p. The
    // second-order term matters if v vanishes but v* does not: then v*^2 <= 4 u^2 p^2. Even u^2 p^2
    // instead of gamma(4)^2 p^2 would suffice, because a hit is certain only above four errors.
    const DVec3 left(d.y * m_.z, d.z * m_.x, d.x * m_.y);
    const DVec3 right(d.z * m_.y, d.x * m_.z, d.y * m_.x);
    const DVec3 v = left - right, p = glm::abs(left) + glm::abs(right);
    const double v2 = glm::dot(v, v), d2 = glm::dot(d, d), rd2 = radius2_ * d2;
    const Approximate discriminant = {.value = rd2 - v2,
                                      .error = gamma(5) * (glm::dot(glm::abs(v), p) + v2 + rd2) +
                                               gamma(4) * gamma(4) * glm::dot(p, p) + kUnderflow};
    if (discriminant.is_negative()) return {.certainty = Certainty::miss};
    const Approximate b = dot_product(d, m_, 4);
    if (b.is_positive() && outside_.is_positive()) return {.certainty = Certainty::miss};
    if (!(discriminant.value > 4 * discriminant.error)) return {.certainty = Certainty::unsure};
    // The squares in d2 are exact, because d has float32 components.
    return first_root_result({.value = d2, .error = gamma(2) * d2 + kUnderflow}, b,
                             square_root(discriminant), range);
  }

 private:
  DVec3 m_;
  double radius2_;         // exact, as a product of two float32 numbers
  Approximate outside_{};  // m.m - r^2, positive if o is outside the sphere
};

/// A quadric Q(p) = 0 relative to the ray origin o: Q(o + t d) = alpha t^2 + (grad Q(o) . d) t +
/// Q(o).
class QuadricFilter {
 public:
  QuadricFilter(const Quadric& q, const Vec3& origin)
      : squares_(q.a, q.b, q.c), mixed_(q.f, q.e, q.d) {
    const DVec3 o = origin, linear(q.g, q.h, q.i), magnitude = glm::abs(o);
    const auto gradient = [&](const DVec3& square, const DVec3& mix, const DVec3& line,
                              const DVec3& p) {
      return DVec3(2 * square.x * p.x + mix.z * p.y + mix.y * p.z + line.x,
                   2 * square.y * p.y + mix.z * p.x + mix.x * p.z + line.y,
                   2 * square.z * p.z + mix.y * p.x + mix.x * p.y + line.z);
    };
    gradient_ = gradient(squares_, mixed_, linear, o);
    gradient_permanent_ =
        gradient(glm::abs(squares_), glm::abs(mixed_), glm::abs(linear), magnitude);
    const double terms = form(squares_, mixed_, o) + glm::dot(linear, o) + double{q.j};
    value_ = {.value = terms,
              .error = gamma(kRoundings) * (form(glm::abs(squares_), glm::abs(mixed_), magnitude) +
                                            glm::dot(glm::abs(linear), magnitude) + std::abs(q.j)) +
                       kUnderflow};
  }

  [[nodiscard]] FilterResult operator()(const DVec3& d, const Range& range) const {
    const DVec3 size = glm::abs(d);
    Approximate alpha = {
        .value = form(squares_, mixed_, d),
        .error = gamma(kRoundings) * form(glm::abs(squares_), glm::abs(mixed_), size) + kUnderflow};
    // beta is half of the coefficient of t.
    Approximate beta = {
        .value = glm::dot(gradient_, d) / 2,
        .error = gamma(kRoundings) * glm::dot(gradient_permanent_, size) / 2 + kUnderflow};
    const double b2 = beta.value * beta.value, ac = alpha.value * value_.value;
    // The error bounds of beta and alpha count more roundings than there are, so they also cover
    // the roundings of the products and of the difference. The roundings of the bound itself are of
    // second order, for which 1 + gamma(8) would suffice.
    const Approximate discriminant = {
        .value = b2 - ac,
        .error = ((2 * std::abs(beta.value) + beta.error) * beta.error +
                  std::abs(alpha.value) * value_.error + std::abs(value_.value) * alpha.error +
                  alpha.error * value_.error) *
                     (1 + gamma(16)) +
                 kUnderflow};
    if (discriminant.is_negative()) return {.certainty = Certainty::miss};
    if (!(discriminant.value > 4 * discriminant.error)) return {.certainty = Certainty::unsure};
    if (alpha.is_negative()) {
      alpha.value = -alpha.value;
      beta.value = -beta.value;
    }
    return first_root_result(alpha, beta, square_root(discriminant), range);
  }

 private:
  // Products of two float32 numbers are exact, and products of three have one rounding. The form of
  // degree two adds five sums: six roundings for alpha. The value Q(o) adds two more sums: eight
  // roundings. beta has six roundings: three sums in the gradient, one product and two sums.
  static constexpr int kRoundings = 8;

  // a x^2 + b y^2 + c z^2 + d xy + e xz + f yz
  static double form(const DVec3& square, const DVec3& mix, const DVec3& p) {
    return square.x * p.x * p.x + square.y * p.y * p.y + square.z * p.z * p.z + mix.z * p.x * p.y +
           mix.y * p.x * p.z + mix.x * p.y * p.z;
  }

  DVec3 squares_,
      mixed_;  // (a, b, c) and (f, e, d): mixed_[k] is the coefficient of the product of the two
               // coordinates other than k
  DVec3 gradient_{}, gradient_permanent_{};
  Approximate value_{};
};

}  // namespace microtrace
