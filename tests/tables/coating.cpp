#include "tables/albedos.hpp"
#include "tables/header_text.hpp"
#include "tables/stated_errors.hpp"
#include "tables/tables.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::tables {
namespace {

constexpr std::size_t kNodes = 8, kRows = 12, kColumns = 16;
constexpr double kUnit = 1.0 / 16384;

using Nodes = std::array<double, kNodes>;

/// The polynomials that are orthogonal over [0, 1] with weight 2 z, computed by the method of
/// Stieltjes: p_k+1 = (z - a_k) p_k - b_k p_k-1.
struct Orthogonal {
  Nodes a{}, b{};

  Orthogonal() {
    const Quadrature exact = gauss_legendre(kNodes + 1);
    double before = 1;
    for (std::size_t k = 0; k < kNodes; ++k) {
      double norm = 0, moment = 0;
      for (std::size_t i = 0; i < exact.at.size(); ++i) {
        const double z = exact.at[i], p = value(k, z), weight = 2 * z * exact.weights[i];
        norm += weight * p * p;
        moment += weight * z * p * p;
      }
      a[k] = moment / norm;
      b[k] = k > 0 ? norm / before : 0;
      before = norm;
    }
  }

  /// Returns p_degree(z).
  [[nodiscard]] double value(std::size_t degree, double z) const {
    double last = 0, result = 1;
    for (std::size_t k = 0; k < degree; ++k) {
      const double next = (z - a[k]) * result - b[k] * last;
      last = result;
      result = next;
    }
    return result;
  }

  /// Returns the zeros of p_degree. Those of p_degree-1 separate them.
  [[nodiscard]] std::vector<double> zeros(std::size_t degree) const {
    if (degree == 0) return {};
    std::vector<double> bounds = zeros(degree - 1), result;
    bounds.insert(bounds.begin(), 0);
    bounds.push_back(1);
    for (std::size_t i = 0; i < degree; ++i) {
      double low = bounds[i], high = bounds[i + 1];
      const bool rises = value(degree, low) < 0;
      for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        ((value(degree, middle) < 0) == rises ? low : high) = middle;
      }
      result.push_back(low);
    }
    return result;
  }
};

Nodes gauss_nodes() {
  Nodes result{};
  const std::vector<double> zeros = Orthogonal().zeros(kNodes);
  for (std::size_t k = 0; k < kNodes; ++k) result[k] = zeros[k];
  return result;
}

/// Returns the values of the nodes' Lagrange polynomials at z.
Nodes lagrange(const Nodes& nodes, double z) {
  Nodes result{};
  for (std::size_t k = 0; k < kNodes; ++k) {
    result[k] = 1;
    for (std::size_t i = 0; i < kNodes; ++i)
      if (i != k) result[k] *= (z - nodes[i]) / (nodes[k] - nodes[i]);
  }
  return result;
}

Nodes gauss_weights(const Nodes& nodes) {
  const Quadrature exact = gauss_legendre(kNodes);
  Nodes result{};
  for (std::size_t i = 0; i < exact.at.size(); ++i) {
    const Nodes l = lagrange(nodes, exact.at[i]);
    for (std::size_t k = 0; k < kNodes; ++k) result[k] += 2 * exact.at[i] * exact.weights[i] * l[k];
  }
  return result;
}

/// Returns the table for F = (1 - cos)^5 if `schlick` is true, otherwise for F = 1.
std::vector<double> deficits(bool schlick) {
  const Nodes nodes = gauss_nodes();
  const Quadrature points = graded(40);
  std::vector<double> result;
  for (std::size_t j = 0; j < kRows; ++j) {
    const double root = static_cast<double>(j) / (kRows - 1), alpha = alpha_of(root * root);
    for (std::size_t i = 0; i < kColumns; ++i) {
      const double step = static_cast<double>(i) / (kColumns - 1), z = step * step;
      const Nodes here = lagrange(nodes, z);
      Nodes sum{};
      over_reflections({.x = alpha, .y = alpha}, tilted(z), points, z, [&](const Reflection& r) {
        if (!(r.wi.z < z)) return;
        const Nodes there = lagrange(nodes, r.wi.z);
        const double weight = r.weight * (schlick ? fifth_power(r.x) : 1);
        for (std::size_t k = 0; k < kNodes; ++k) sum[k] += weight * (here[k] - there[k]);
      });
      for (const double deficit : sum) result.push_back(deficit / kUnit);
    }
  }
  return result;
}

std::string deficit_text(const std::string& name, bool schlick) {
  return table_text("DeficitTable " + name, deficits(schlick), {kRows, kColumns, kNodes}, 0);
}

}  // namespace

std::string coating_table() {
  const Nodes nodes = gauss_nodes(), weights = gauss_weights(nodes);
  return header_text(
      "Energy deficit of microfacets below a coating. This is the light to or from z = cos(theta) "
      "that white microfacets reflect into directions of lower transmittance T, the integral over "
      "wi of\n"
      "\n"
      "  F D(h) G2(wo, wi) / (4 z wi.z) wi.z max(T(z) - T(wi.z), 0).\n"
      "\n"
      "T is assumed to increase with z. It is the Lagrange polynomial through its values at eight "
      "nodes, so the deficit is linear in these values. Entries are rounded integrals.\n"
      "\n"
      "Under a clear coat, deficits for F = 1 are " +
          error_text(kDeficitF1Error) + ". Deficits for F = (1 - cos)^5 are " +
          error_text(kDeficitSchlickError) + ".\n",
      {"array", "cstddef", "cstdint"},
      "inline constexpr std::size_t kCoatingNodes = 8, kCoatingRows = 12, kCoatingColumns = 16;\n"
      "\n"
      "// clang-format off\n"
      "\n"
      "/// Nodes and weights of Gauss quadrature of functions of z over [0, 1] with weight 2 z.\n" +
          table_text("std::array<float, kCoatingNodes> kCoatingNode", nodes, {kNodes}, 8) +
          table_text("std::array<float, kCoatingNodes> kCoatingWeight", weights, {kNodes}, 8) +
          "\n"
          "/// The unit of the tables' entries.\n"
          "inline constexpr float kDeficitUnit = 1 / 16384.0F;\n"
          "\n"
          "/// Entry [j][i][k] is the coefficient of T at node k for sqrt(roughness) = j / 11 and\n"
          "/// sqrt(z) = i / 15.\n"
          "using DeficitTable =\n"
          "    std::array<std::array<std::array<std::int16_t, kCoatingNodes>, kCoatingColumns>, "
          "kCoatingRows>;\n"
          "\n"
          "/// For F = 1.\n" +
          deficit_text("kDeficitF1", false) + "\n// clang-format on\n");
}

std::string coating_schlick_table() {
  return header_text(
      "The counterpart of kDeficitF1 in coating_table.hpp for F = (1 - cos)^5.\n",
      {"render/bsdf/tables/coating_table.hpp"},
      "// clang-format off\n\n" + deficit_text("kDeficitSchlick", true) + "\n// clang-format on\n");
}

}  // namespace microtrace::tables
