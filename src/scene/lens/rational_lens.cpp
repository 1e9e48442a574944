#include "scene/lens/rational_lens.hpp"

#include "scene/math/roots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

namespace microtrace {
namespace {

/// Undistorted points farther from the axis than this have no ray, which avoids overflow. Little is
/// lost: their directions are within a millionth of a radian of perpendicular to the axis.
constexpr double kMaxRadius = 1e6;

/// A polynomial's coefficients, starting with the constant.
using Polynomial = std::vector<double>;

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

// Returns a + factor b.
Polynomial sum(Polynomial a, double factor, const Polynomial& b) {
  a.resize(std::max(a.size(), b.size()));
  for (std::size_t i = 0; i < b.size(); ++i) a[i] += factor * b[i];
  return a;
}

}  // namespace

RationalLens::RationalLens(const RationalDistortion& k) : k_(k), max_radius_(invertible_radius()) {
  max_distorted_ = max_radius_ * radial(max_radius_ * max_radius_).factor;
}

RationalLens::Radial RationalLens::radial(double s) const {
  const double n = 1 + s * (k_.k1 + s * (k_.k2 + s * k_.k3));
  const double d = 1 + s * (k_.k4 + s * (k_.k5 + s * k_.k6));
  const double dn = k_.k1 + s * (2 * k_.k2 + s * (3 * k_.k3));
  const double dd = k_.k4 + s * (2 * k_.k5 + s * (3 * k_.k6));
  const double factor = n / d;
  return {.factor = factor, .slope = (dn - factor * dd) / d};
}

// The Jacobian is the sum of two symmetric matrices. With the radial factor R = N / D, the first
// has the eigenvalues R and (r R)'. The eigenvalues of the second, the tangential part, are at
// least -6 |p| r. The sum is therefore positive definite where R and (r R)' exceed 6 |p| r.
// Multiplied by D and D^2, these conditions are inequalities of polynomials.
double RationalLens::invertible_radius() const {
  // Polynomials in r.
  const Polynomial n{1, 0, k_.k1, 0, k_.k2, 0, k_.k3}, d{1, 0, k_.k4, 0, k_.k5, 0, k_.k6};
  const Polynomial r_dn{0, 0, 2 * k_.k1, 0, 4 * k_.k2, 0, 6 * k_.k3};  // r N'
  const Polynomial r_dd{0, 0, 2 * k_.k4, 0, 4 * k_.k5, 0, 6 * k_.k6};
  const double p = 6 * std::sqrt(k_.p1 * k_.p1 + k_.p2 * k_.p2);
  const Polynomial bound{0, p};
  const Polynomial stretch = sum(sum(n * d, 1, r_dn * d), -1, n * r_dd);  // (r R)' D^2
  const double limit =
      std::min({least_positive_root(d), least_positive_root(sum(stretch, -1, bound * d * d)),
                least_positive_root(sum(n, -1, bound * d))});
  return std::min(limit * (1 - 0x1p-40), kMaxRadius);
}

DVec2 RationalLens::distorted(const DVec2& u) const {
  const double xy = u.x * u.y, s = glm::dot(u, u), factor = radial(s).factor;
  return {u.x * factor + 2 * k_.p1 * xy + k_.p2 * (s + 2 * u.x * u.x),
          u.y * factor + k_.p1 * (s + 2 * u.y * u.y) + 2 * k_.p2 * xy};
}

RationalLens::Jacobian RationalLens::jacobian(const DVec2& u) const {
  const Radial f = radial(glm::dot(u, u));
  return {.xx = f.factor + 2 * u.x * u.x * f.slope + 2 * k_.p1 * u.y + 6 * k_.p2 * u.x,
          .xy = 2 * u.x * u.y * f.slope + 2 * k_.p1 * u.x + 2 * k_.p2 * u.y,
          .yy = f.factor + 2 * u.y * u.y * f.slope + 6 * k_.p1 * u.y + 2 * k_.p2 * u.x};
}

DVec2 RationalLens::Jacobian::solve(const DVec2& w) const {
  // The minimum keeps the result finite if rounding moves the point to the edge of the invertible
  // disk.
  constexpr double kLeast = 1e-9;
  return DVec2(yy * w.x - xy * w.y, xx * w.y - xy * w.x) / std::max(determinant(), kLeast);
}

std::optional<DVec3> RationalLens::direction(const DVec2& image) const {
  const double length = std::sqrt(glm::dot(image, image));
  if (!(length > 0)) return DVec3(0, 0, 1);
  if (k_.p1 == 0 && k_.p2 == 0) {
    if (!(length <= max_distorted_)) return std::nullopt;
    return DVec3(image * (undistorted_radius(length) / length), 1);
  }
  // The solution in the disk is unique, so it doesn't matter which start converges. The first start
  // converges fastest.
  const double clamped = std::min(1.0, max_radius_ / length);
  std::optional<DVec2> u = undistorted(image, image * clamped);
  if (!u) u = undistorted(image, image * (undistorted_radius(length) / length));
  if (!u) u = undistorted(image, DVec2(0));
  return u ? std::optional(DVec3(*u, 1)) : std::nullopt;
}

double RationalLens::undistorted_radius(double distorted_radius) const {
  if (distorted_radius >= max_distorted_) return max_radius_;
  const auto radius = [this](double r) {
    const Radial f = radial(r * r);
    return ValueAndSlope{.value = r * f.factor, .slope = f.factor + 2 * r * r * f.slope};
  };
  return solve_increasing(radius, distorted_radius, 0, max_radius_);
}

std::optional<DVec2> RationalLens::undistorted(const DVec2& image, DVec2 u) const {
  const double size = glm::dot(image, image);
  const double tolerance = 1e-24 * std::max(1.0, size);
  DVec2 error = distorted(u) - image;
  double square = glm::dot(error, error);
  for (int i = 0; i < 100 && square > 0; ++i) {
    const DVec2 step = jacobian(u).solve(error);
    bool is_better = false;
    const double least_part = square <= tolerance ? 1 : 0x1p-12;
    for (double part = 1; part >= least_part && !is_better; part /= 2) {
      const DVec2 v = u - part * step;
      if (glm::dot(v, v) > max_radius_ * max_radius_) continue;
      const DVec2 e = distorted(v) - image;
      if (!(glm::dot(e, e) < square)) continue;
      is_better = true;
      u = v;
      error = e;
      square = glm::dot(e, e);
    }
    if (!is_better) break;
  }
  return square <= tolerance ? std::optional(u) : std::nullopt;
}

std::optional<DVec2> RationalLens::image(const DVec3& direction) const {
  if (!(direction.z > 0)) return std::nullopt;
  const DVec2 u = DVec2(direction) / direction.z;
  if (!(glm::dot(u, u) <= max_radius_ * max_radius_)) return std::nullopt;
  return distorted(u);
}

LensDifferential RationalLens::differential(const DVec3& d) const {
  const Jacobian j = jacobian(DVec2(d) / d.z);
  // Differentiates d = toward / |toward|, where `toward` has depth 1.
  const auto turned = [&](const DVec3& step) { return d.z * (step - d * glm::dot(d, step)); };
  return {.dx = turned(DVec3(j.solve(DVec2(1, 0)), 0)),
          .dy = turned(DVec3(j.solve(DVec2(0, 1)), 0))};
}

}  // namespace microtrace
