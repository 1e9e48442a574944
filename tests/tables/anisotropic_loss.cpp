#include "tables/albedos.hpp"
#include "tables/alpha_pairs.hpp"
#include "tables/fit.hpp"
#include "tables/header_text.hpp"
#include "tables/stated_errors.hpp"
#include "tables/tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace microtrace::tables {
namespace {

/// The number of powers of each variable. The loss and its edge term have four variables, and their
/// means have two.
constexpr std::size_t kAlphaPowers = 5, kAzimuthPowers = 5, kCosinePowers = 8;
constexpr std::size_t kEdgeAlphaPowers = 5, kEdgeAzimuthPowers = 6, kEdgeCosinePowers = 6;
constexpr std::size_t kMeanPowers = 7;
constexpr double kLossPenalty = 5, kEdgePenalty = 60;

/// Appends the first powers of 2 x - 1.
void append_powers(Points& row, double x, std::size_t count) {
  double power = 1;
  for (std::size_t k = 0; k < count; ++k) {
    row.push_back(power);
    power *= 2 * x - 1;
  }
}

Points powers_of(double x, std::size_t count) {
  Points row;
  append_powers(row, x, count);
  return row;
}

/// Returns the matrix of the polynomials at these points. Each row is multiplied by a weight.
Factors polynomials(const Points& at, std::size_t count, const Points& weights) {
  Points matrix;
  for (std::size_t i = 0; i < at.size(); ++i)
    for (const double power : powers_of(at[i], count)) matrix.push_back(weights[i] * power);
  return {matrix, count};
}

Points pair_powers(const Pair& pair, std::size_t count) {
  Points result;
  for (const double x : powers_of(pair.smaller, count))
    for (const double y : powers_of(pair.greater, count)) result.push_back(x * y);
  return result;
}

Factors pair_polynomials(const std::vector<Pair>& at, std::size_t count, const Points& weights) {
  Points matrix;
  for (std::size_t i = 0; i < at.size(); ++i)
    for (const double power : pair_powers(at[i], count)) matrix.push_back(weights[i] * power);
  return {matrix, count * count};
}

/// The azimuth in whose direction the effective alpha has a given value. `place` is the position of
/// this alpha's square root between those of the pair. direction(z) is the direction with cosine z
/// and this azimuth.
struct Azimuth {
  double alpha, cosine, sine;

  Azimuth(const Pair& pair, double place)
      : alpha(pair.smaller + place * (pair.greater - pair.smaller)) {
    alpha *= alpha;
    const double a = pair.alpha_y() * pair.alpha_y(), b = pair.alpha_x() * pair.alpha_x();
    const double square = b > a ? std::clamp((alpha * alpha - a) / (b - a), 0.0, 1.0) : place;
    cosine = std::sqrt(square);
    sine = std::sqrt(1 - square);
  }

  [[nodiscard]] Direction direction(double z) const {
    const double across = std::sqrt(1 - z * z);
    return {.x = across * cosine, .y = across * sine, .z = z};
  }
};

double bent_cosine(double s, double alpha) {
  return std::min(alpha * s / (1 + alpha - s), 1.0);
}

/// The coefficients of a polynomial, and the function that evaluates it.
struct Polynomial4 {
  Points coefficients;
  std::size_t alphas, azimuths, cosines;

  [[nodiscard]] double value(const Pair& pair, double azimuth, double cosine) const {
    const Points u = pair_powers(pair, alphas), v = powers_of(azimuth, azimuths),
                 w = powers_of(cosine, cosines);
    double sum = 0;
    std::size_t at = 0;
    for (const double x : u)
      for (const double y : v)
        for (const double z : w) sum += x * y * z * coefficients[at++];
    return sum;
  }
};

void round_to(Points& values, int decimals) {
  for (double& value : values) value = rounded(value, decimals);
}

const Quadrature& points() {
  static const Quadrature result = graded(28);
  return result;
}

constexpr std::size_t kRoughnesses = 12, kStrengths = 10;

Polynomial4 loss_fit() {
  const std::vector<Pair> at = pairs(chebyshev(kRoughnesses), chebyshev(kStrengths));
  const Points azimuths = chebyshev(9), cosines = chebyshev(14);
  Points losses;
  for (const Pair& pair : at) {
    for (const double place : azimuths) {
      const Azimuth azimuth(pair, place);
      for (const double s : cosines) {
        const Direction wo = azimuth.direction(bent_cosine(s, azimuth.alpha));
        losses.push_back(1 -
                         ggx_albedo({.x = pair.alpha_x(), .y = pair.alpha_y()}, wo, points()).f1);
      }
    }
  }
  Polynomial4 result{
      .coefficients = low_fit({pair_polynomials(at, kAlphaPowers, Points(at.size(), 1)),
                               polynomials(azimuths, kAzimuthPowers, Points(azimuths.size(), 1)),
                               polynomials(cosines, kCosinePowers, Points(cosines.size(), 1))},
                              losses, kLossPenalty),
      .alphas = kAlphaPowers,
      .azimuths = kAzimuthPowers,
      .cosines = kCosinePowers};
  round_to(result.coefficients, 5);
  return result;
}

Polynomial4 edge_fit() {
  const std::vector<Pair> at = pairs(chebyshev(kRoughnesses), middles(kStrengths));
  // Equidistant angles, for pairs in which one alpha is much larger
  Points azimuths;
  for (int i = 0; i <= 16; ++i) azimuths.push_back(cos_radians(i * std::numbers::pi / 32));
  const Points cosines = middles(12);
  Points differences, pair_weights, cosine_weights;
  for (const Pair& pair : at) pair_weights.push_back(pair.greater - pair.smaller);
  for (const double root : cosines) cosine_weights.push_back(1 - root);
  for (const Pair& pair : at) {
    const Alphas alphas{.x = pair.alpha_x(), .y = pair.alpha_y()};
    for (const double place : azimuths) {
      const Azimuth azimuth(pair, place);
      const Alphas alike{.x = azimuth.alpha, .y = azimuth.alpha};
      for (const double root : cosines) {
        const double z = root * root;
        const double difference = ggx_albedo(alphas, azimuth.direction(z), points()).schlick -
                                  ggx_albedo(alike, tilted(z), points()).schlick;
        differences.push_back(-difference);
      }
    }
  }
  // Fits the negative of the term, because low_fit() rarely exceeds its targets and the term should
  // rarely be too small.
  Polynomial4 result{.coefficients = low_fit(
                         {pair_polynomials(at, kEdgeAlphaPowers, pair_weights),
                          polynomials(azimuths, kEdgeAzimuthPowers, Points(azimuths.size(), 1)),
                          polynomials(cosines, kEdgeCosinePowers, cosine_weights)},
                         differences, kEdgePenalty),
                     .alphas = kEdgeAlphaPowers,
                     .azimuths = kEdgeAzimuthPowers,
                     .cosines = kEdgeCosinePowers};
  for (double& c : result.coefficients) c = -c;
  round_to(result.coefficients, 4);
  return result;
}

/// Polynomials in the square roots of both alphas, which approximate the means of the loss and of
/// the edge term.
struct Means {
  Points loss, edge;
};

Means mean_fit(const Polynomial4& loss, const Polynomial4& edge) {
  const std::vector<Pair> at = pairs(chebyshev(14), chebyshev(10));
  const Quadrature cosines = graded(14), turns = gauss_legendre(10);
  Points losses, edges;
  for (const Pair& pair : at) {
    double mean_loss = 0, mean_edge = 0;
    for (std::size_t j = 0; j < turns.at.size(); ++j) {
      const double turn = turns.at[j] * std::numbers::pi / 2;
      const double x = pair.alpha_x() * cos_radians(turn), y = pair.alpha_y() * sin_radians(turn);
      const double alpha = std::sqrt(x * x + y * y), range = pair.greater - pair.smaller;
      const double place =
          range > 0 ? std::clamp((std::sqrt(alpha) - pair.smaller) / range, 0.0, 1.0) : 0;
      for (std::size_t k = 0; k < cosines.at.size(); ++k) {
        const double z = cosines.at[k], root = std::sqrt(z);
        const double weight = 2 * z * cosines.weights[k] * turns.weights[j];
        const double lost =
            std::clamp(loss.value(pair, place, z * (1 + alpha) / (z + alpha)), 0.0, 1.0);
        const double alike = ggx_albedo({.x = alpha, .y = alpha}, tilted(z), points()).schlick;
        const double more = range * (1 - root) * edge.value(pair, place, root);
        mean_loss += weight * lost;
        mean_edge += weight * std::clamp(alike + more, 0.0, 1 - lost);
      }
    }
    losses.push_back(mean_loss);
    edges.push_back(mean_edge);
  }
  const std::vector<Factors> axes{pair_polynomials(at, kMeanPowers, Points(at.size(), 1))};
  return {.loss = fit(axes, losses), .edge = fit(axes, edges)};
}

std::vector<std::size_t> sizes(const Polynomial4& p) {
  return {p.alphas, p.alphas, p.azimuths, p.cosines};
}

}  // namespace

std::string anisotropic_loss_table() {
  const Polynomial4 loss = loss_fit();
  const Means means = mean_fit(loss, edge_fit());
  return header_text(
      "Albedos of an anisotropic GGX reflector, as polynomials that are fitted to the integrals of "
      "ggx_albedo_table.hpp. The fit of the loss rarely exceeds the integral, and the fit of the "
      "Schlick term in anisotropic_schlick_table.hpp is rarely below it.\n"
      "\n"
      "As AnisotropicGgxAlbedo evaluates them, albedos for F = 1 are " +
          error_text(kAnisotropicF1Error) + ". Albedos for Schlick's term are " +
          error_text(kAnisotropicSchlickError) + ". Means for F = 1 are " +
          error_text(kAnisotropicMeanF1Error) + ". Means for Schlick's term are " +
          error_text(kAnisotropicMeanSchlickError) + ".\n",
      {"render/bsdf/polynomial.hpp", "array"},
      "// clang-format off\n"
      "\n"
      "/// The energy deficit of single scattering for F = 1, by powers of four variables 2 x - 1 "
      "in\n"
      "/// [-1, 1]. The four x are sqrt(a), sqrt(b), (sqrt(c) - sqrt(a)) / (sqrt(b) - sqrt(a)) "
      "and\n"
      "/// z (1 + c) / (z + c). a is the smaller alpha, b the greater alpha, c the alpha along "
      "the\n"
      "/// direction, and z = cos(theta).\n"
      "using AnisotropicLossPlane = Polynomial2<5, 8>;\n" +
          table_text("std::array<std::array<AnisotropicLossPlane, 5>, 5> kAnisotropicLoss",
                     loss.coefficients, sizes(loss), 5) +
          "\n/// The cosine-weighted means of these albedos, by powers of the first two "
          "variables.\n" +
          table_text("Polynomial2<7, 7> kMeanAnisotropicLoss", means.loss,
                     {kMeanPowers, kMeanPowers}, 6) +
          table_text("Polynomial2<7, 7> kMeanAnisotropicSchlick", means.edge,
                     {kMeanPowers, kMeanPowers}, 6) +
          "\n// clang-format on\n");
}

std::string anisotropic_schlick_table() {
  const Polynomial4 edge = edge_fit();
  return header_text(
      "The albedo of an anisotropic GGX reflector for F = (1 - cos)^5, as a polynomial.\n",
      {"render/bsdf/tables/anisotropic_loss_table.hpp"},
      "// clang-format off\n"
      "\n"
      "/// The albedo of single scattering minus that of an isotropic reflector of alpha c, "
      "divided "
      "by\n"
      "/// (sqrt(b) - sqrt(a)) (1 - sqrt(z)). The variables are those of kAnisotropicLoss, except "
      "that\n"
      "/// the last x is sqrt(z).\n"
      "using AnisotropicSchlickPlane = Polynomial2<6, 6>;\n" +
          table_text("std::array<std::array<AnisotropicSchlickPlane, 5>, 5> kAnisotropicSchlick",
                     edge.coefficients, sizes(edge), 4) +
          "\n// clang-format on\n");
}

}  // namespace microtrace::tables
