#pragma once
#include "accel/filters/filter.hpp"

#include <microtrace/shape.hpp>

#include <glm/geometric.hpp>

namespace microtrace {

/// Computes the two roots (-b -+ s) / a in ascending order, with error bounds of the numerators; a
/// is certainly positive, and s is the root of the discriminant. The first root that is certainly
/// in range is the hit; a root that may be in range makes the result unsure.
[[nodiscard]] inline FilterResult first_root_result(const Approximate& a, const Approximate& b,
                                                    const Approximate& s, const Range& range) {
  const double error = b.error + s.error + gamma(1) * (std::abs(b.value) + s.value);
  const FilterResult near =
      quotient_result({.value = -b.value - s.value, .error = error}, a, range);
  if (near.certainty != Certainty::miss) return near;
  return quotient_result({.value = -b.value + s.value, .error = error}, a, range);
}

/// The square root of a number that is certainly positive: |sqrt(x) - sqrt(x*)| <= error / sqrt(x)
/// for error <= x. Callers make sure that x is at least four times the error. Half of gamma(4)
/// would suffice, because it covers two roundings of second order.
[[nodiscard]] inline Approximate square_root(const Approximate& x) {
  const double root = std::sqrt(x.value);
  return {.value = root, .error = x.error / root * (1 + gamma(4)) + gamma(1) * root};
}

/// A sphere relative to the ray origin o. With m = o - center: (d.d) t^2 + 2 (d.m) t + m.m - r^2 =
/// 0. By Lagrange's identity the discriminant is r^2 d.d - |d x m|^2, without the cancellation of
/// (d.m)^2 - (d.d)(m.m - r^2).
class SphereFilter {
 public:
  SphereFilter(const Sphere& sphere, const Vec3& o)
      : m_(DVec3(o) - DVec3(sphere.center)), radius2_(double{sphere.radius} * sphere.radius) {
    const double m2 = glm::dot(m_, m_);
    // Only its sign is used. It has two roundings of m, one of the squares, two of their sum.
    outside_ = {.value = m2 - radius2_, .error = gamma(5) * m2 + kUnderflow};
  }

  [[nodiscard]] FilterResult operator()(const DVec3& d, const Range& range) const {
    // v = d x m has the roundings of m, of the products and of the difference: |v - v*| <= u (2 p +
    // |v|) for the permanent p of a component, so |v^2 - v*^2| <= u (4 |v| p + 2 v^2) + u^2 (2 p +
    // |v|)^2. v^2 has three more roundings, d^2 r^2 three and the difference one: in all u (4 |v| p
    // + 6 v^2 + 4 d^2 r^2), and v^2 <= |v| p. The second-order term matters if v vanishes but v*
    // does not: there u^2 p^2 would suffice four times over, because a hit is certain only above
    // four errors.
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
    // The squares are exact.
    return first_root_result({.value = d2, .error = gamma(2) * d2 + kUnderflow}, b,
                             square_root(discriminant), range);
  }

 private:
  DVec3 m_;
  double radius2_;         // exact: a product of two float32
  Approximate outside_{};  // m.m - r^2: positive outside the sphere
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
    // beta is half of the product with the gradient.
    Approximate beta = {
        .value = glm::dot(gradient_, d) / 2,
        .error = gamma(kRoundings) * glm::dot(gradient_permanent_, size) / 2 + kUnderflow};
    const double b2 = beta.value * beta.value, ac = alpha.value * value_.value;
    // The roundings of the products and of the difference are within the bounds of beta and alpha,
    // which count more roundings than there are. The roundings of the bound itself are of second
    // order: 1 + gamma(8) would suffice.
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
  // Products of two float32 are exact, products of three have one rounding. Five sums in the form
  // of three products follow: six roundings for alpha, and eight for the value with its two more
  // sums. beta has three sums in the gradient, one product and two sums: six.
  static constexpr int kRoundings = 8;

  // a x^2 + b y^2 + c z^2 + d xy + e xz + f yz
  static double form(const DVec3& square, const DVec3& mix, const DVec3& p) {
    return square.x * p.x * p.x + square.y * p.y * p.y + square.z * p.z * p.z + mix.z * p.x * p.y +
           mix.y * p.x * p.z + mix.x * p.y * p.z;
  }

  DVec3 squares_,
      mixed_;  // (a, b, c) and (f, e, d): mixed_[k] multiplies the two other coordinates
  DVec3 gradient_{}, gradient_permanent_{};
  Approximate value_{};
};

}  // namespace microtrace
