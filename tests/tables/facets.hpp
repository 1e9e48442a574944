#pragma once
/// Integrates over the microfacets of a GGX surface (B. Walter et al., Microfacet models for
/// refraction, 2007; E. Heitz, Understanding the masking-shadowing function, 2014). z is the
/// surface's normal. Directions are unit vectors.

#include "scene/math/trigonometry.hpp"
#include "tables/quadrature.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace microtrace::tables {

struct Direction {
  double x, y, z;
};

/// Returns the direction with cosine z in the plane y = 0.
inline Direction tilted(double z) {
  return {.x = std::sqrt(1 - z * z), .y = 0, .z = z};
}

/// The alphas along x and y.
struct Alphas {
  double x, y;

  /// Returns a term of all masking functions: G1(w) = 2 w.z / (w.z + root(w)).
  [[nodiscard]] double root(const Direction& w) const {
    const double a = w.x * x, b = w.y * y;
    return std::sqrt(a * a + b * b + w.z * w.z);
  }
};

/// A facet with the normal h = (x, y, 1) / |(x, y, 1)|.
struct Facet {
  double x, y, square;  ///< `square` is |(x, y, 1)|^2
  double dot;           ///< wo . (x, y, 1)
  double weight;        ///< D(h) (wo . h) dh
};

/// Angles from 0 to pi in ascending order. The integrand may change quickly near each of them.
inline constexpr std::array kHalves{0.0, std::numbers::pi / 2, std::numbers::pi};

/// Calls visit(facet) for the points of a quadrature over the facets visible from wo. With (x, y) =
/// t (alpha_x cos(a), alpha_y sin(a)),
///
/// D(h) (h . z) dh = 2 t / (1 + t^2)^2 dt da / (2 pi),   wo . (x, y, 1) = wo.z + p t.
///
/// `turns` divides the angles on both sides of the angle at which p has its maximum. With
/// q = (x^2 + y^2) / t^2, cuts(p, q) returns an array of t in ascending order, which divides the
/// range of the integral.
template <typename Turns, typename Cuts, typename Visit>
void over_facets(const Alphas& alphas, const Direction& wo, const Quadrature& points,
                 const Turns& turns, const Cuts& cuts, const Visit& visit) {
  const double px = wo.x * alphas.x, py = wo.y * alphas.y;
  const double most = std::sqrt(px * px + py * py);
  const double cos_p = most > 0 ? px / most : 1, sin_p = most > 0 ? py / most : 0;
  const auto ray = [&](double cosine, double sine, double share) {
    const double x = alphas.x * (cosine * cos_p - sine * sin_p);
    const double y = alphas.y * (cosine * sin_p + sine * cos_p);
    const double p = most * cosine, q = x * x + y * y;
    const auto limits = cuts(p, q);
    // t = s / (1 - s), which is infinite for s = 1.
    const auto s_of = [](double t) { return std::isinf(t) ? 1 : t / (1 + t); };
    for (std::size_t part = 0; part + 1 < limits.size(); ++part) {
      const double from = s_of(limits[part]), width = s_of(limits[part + 1]) - from;
      if (!(width > 0)) continue;
      for (std::size_t k = 0; k < points.at.size(); ++k) {
        const double s = from + width * points.at[k], r = 1 - s, sum = r * r + s * s;
        const double t = s / r, dot = wo.z + p * t;
        if (!(dot > 0)) continue;
        const double density = dot * 2 * s * r / (sum * sum);
        visit(Facet{.x = x * t,
                    .y = y * t,
                    .square = 1 + q * t * t,
                    .dot = dot,
                    .weight = share * width * points.weights[k] * density});
      }
    }
  };
  // If wo is in the plane of an axis, both sides contribute equally.
  const bool is_symmetric = alphas.x == alphas.y || px == 0 || py == 0;
  const double share = (is_symmetric ? 2 : 1) / (2 * std::numbers::pi);
  for (std::size_t part = 0; part + 1 < turns.size(); ++part) {
    const double from = turns[part], width = turns[part + 1] - from;
    if (!(width > 0)) continue;
    for (std::size_t k = 0; k < points.at.size(); ++k) {
      const double turn = from + width * points.at[k];
      const double cosine = cos_radians(turn), sine = sin_radians(turn);
      ray(cosine, sine, share * width * points.weights[k]);
      if (!is_symmetric) ray(cosine, -sine, share * width * points.weights[k]);
    }
  }
}

/// Returns the largest t for which a facet reflects wo above the surface.
inline double reflection_end(double z, double p, double q) {
  const double root = std::sqrt(p * p + z * z * q);
  if (p <= 0) return z > 0 ? z / (root - p) : 0;
  return z > 0 ? (p + root) / (z * q) : std::numeric_limits<double>::infinity();
}

/// The light from wo that a facet reflects above the surface.
struct Reflection {
  Direction wi;
  double x;       ///< 1 - wo . h
  double weight;  ///< G2(wo, wi) D(h) (wo . h) / wo.z dh
};

/// Calls visit(reflection) for the points of a quadrature over the facets that reflect wo above the
/// surface. The weights sum to the directional albedo of single scattering for F = 1. `least` is a
/// cosine at which the integrand may have an edge: 0 or wo.z.
template <typename Visit>
void over_reflections(const Alphas& alphas, const Direction& wo, const Quadrature& points,
                      double least, const Visit& visit) {
  const auto cuts = [&](double p, double q) {
    const double end = reflection_end(wo.z, p, q);
    double edge = 0;
    if (least > 0 && p > 0) edge = p / (wo.z * q);  // t of facets that reflect to the cosine wo.z
    return std::array{0.0, edge, end};
  };
  const double root = alphas.root(wo);
  over_facets(alphas, wo, points, kHalves, cuts, [&](const Facet& f) {
    const double twice = 2 * f.dot / f.square;
    const Direction wi{.x = twice * f.x - wo.x, .y = twice * f.y - wo.y, .z = twice - wo.z};
    if (!(wi.z > 0)) return;
    const double g2 = 2 * wi.z / (wo.z * alphas.root(wi) + wi.z * root);  // G2 divided by wo.z
    visit(Reflection{.wi = wi, .x = 1 - f.dot / std::sqrt(f.square), .weight = f.weight * g2});
  });
}

}  // namespace microtrace::tables
