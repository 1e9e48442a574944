#include "tables/albedos.hpp"

#include "scene/math/exponential.hpp"
#include "scene/math/trigonometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace microtrace::tables {

double alpha_of(double roughness) {
  return std::max(roughness * roughness, 0.001);
}

double fifth_power(double x) {
  return x * x * x * x * x;
}

Albedo ggx_albedo(const Alphas& alphas, const Direction& wo, const Quadrature& points) {
  Albedo sum;
  over_reflections(alphas, wo, points, 0, [&](const Reflection& r) {
    sum.f1 += r.weight;
    sum.schlick += r.weight * fifth_power(r.x);
  });
  return sum;
}

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
  double begin = 0, end = 0;
};

/// Returns the interval of t >= 0 in which facets transmit light, in the terms of over_facets().
/// There, z + p t >= c sqrt(1 + q t^2), where c is the cosine of the critical angle. The left side
/// is linear and the right side convex, so this is an interval.
Interval transmitting(double z, double p, double q, double c) {
  // Squared, the condition is a t^2 + 2 b t + d >= 0.
  const double a = p * p - c * c * q, b = z * p, d = z * z - c * c, square = b * b - a * d;
  if (square < 0) return {};
  const double root = std::sqrt(square);
  if (a < 0) return {.begin = std::max((root - b) / a, 0.0), .end = std::max((-root - b) / a, 0.0)};
  if (p > 0) return {.begin = d < 0 ? -d / (b + root) : 0, .end = kInfinity};
  return {.begin = 0, .end = d > 0 ? d / (root - b) : 0};
}

}  // namespace

RefractionLoss refraction_loss(double alpha, double z, double eta, const Quadrature& points) {
  const Alphas alphas{.x = alpha, .y = alpha};
  const Direction wo = tilted(z);
  const double root = alphas.root(wo), masking = 2 * z / (z + root);
  const double head_on = (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1));
  const double critical = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
  double turn = std::numbers::pi / 2;  // at larger angles, no facet transmits light
  if (z < critical) {
    const double cosine = std::sqrt((critical * critical - z * z) / (1 - z * z));
    turn = atan_radians(std::sqrt(1 - cosine * cosine) / cosine);
  }
  const std::array turns{0.0, turn, std::numbers::pi / 2, std::numbers::pi};
  const auto cuts = [&](double p, double q) {
    const double end = p < 0 ? -z / p : kInfinity;
    const Interval through =
        eta < 1 ? transmitting(z, p, q, critical) : Interval{.begin = 0, .end = end};
    std::array result{0.0, through.begin, through.end, reflection_end(z, p, q), end};
    for (double& t : result) t = std::min(t, end);
    std::sort(result.begin(), result.end());
    return result;
  };
  double sum = 0;
  RefractionLoss result;
  over_facets(alphas, wo, points, turns, cuts, [&](const Facet& f) {
    const double h = 1 / std::sqrt(f.square), cosine = f.dot * h;
    if (!(cosine > 0)) return;  // NaN if t is infinite
    const double square = 1 - (1 - cosine * cosine) / (eta * eta);
    const double refracted = std::sqrt(std::max(square, 0.0));
    const double edge = fifth_power(1 - (eta < 1 ? refracted : cosine));
    const double fresnel = head_on + (1 - head_on) * edge;
    const double up = 2 * f.dot / f.square - z;
    double reflected = 0, transmitted = 0;  // if the facet reflects or transmits all light
    if (up > 0)
      reflected = f.weight * 2 * up / (z * alphas.root(tilted(std::min(up, 1.0))) + up * root);
    sum += reflected * fresnel;
    if (!(square > 0)) return;
    const double down = std::min(z / eta - (cosine / eta - refracted) * h, 1.0);
    if (down > 0) {
      const double below = 2 * down / (down + alphas.root(tilted(down)));
      transmitted = f.weight * 2 / (z + root) * (below < masking ? below / masking : 1);
    }
    sum += transmitted * (1 - fresnel);
    result.by_f0 += (transmitted - reflected) * (1 - edge);
    result.by_f90 += (transmitted - reflected) * edge;
  });
  result.loss = 1 - sum;
  return result;
}

double Sheen::lambda(double z) const {
  // The fit published in the paper.
  const double t = (1 - alpha_) * (1 - alpha_);
  const auto mix = [t](double rough, double smooth) { return rough + t * (smooth - rough); };
  const auto fit = [&](double x) {
    return mix(21.5473, 25.3245) / (1 + mix(3.82987, 3.32435) * power(x, mix(0.19823, 0.16801))) +
           mix(-1.97760, -1.27393) * x + mix(-4.32054, -4.85967);
  };
  return z < 0.5 ? exponential(fit(z)) : exponential(2 * fit(0.5) - fit(1 - z));
}

double Sheen::around(double z, double z_in, double masking, const Quadrature& points) const {
  const Direction wo = tilted(z), wi = tilted(z_in);
  double sum = 0;
  for (std::size_t k = 0; k < points.at.size(); ++k) {
    const double turn = std::numbers::pi * points.at[k];
    const double x = wo.x + wi.x * cos_radians(turn), y = wi.x * sin_radians(turn);
    const double across = x * x + y * y, along = (z + z_in) * (z + z_in);
    const double sine_square = across / (across + along);
    sum += points.weights[k] * power(sine_square, 0.5 / alpha_);
  }
  return sum * (2 + 1 / alpha_) / (4 * masking * z * z_in);
}

double Sheen::albedo(double z, const Quadrature& points) const {
  const double here = 1 + lambda(z);
  double sum = 0;
  for (const double from : {0.0, 0.5}) {  // the fit's derivative is discontinuous at 0.5
    for (std::size_t k = 0; k < points.at.size(); ++k) {
      const double z_in = from + 0.5 * points.at[k];
      sum += 0.5 * points.weights[k] * z_in * around(z, z_in, here + lambda(z_in), points);
    }
  }
  return sum;
}

}  // namespace microtrace::tables
