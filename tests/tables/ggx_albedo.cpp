#include "tables/albedos.hpp"
#include "tables/header_text.hpp"
#include "tables/stated_errors.hpp"
#include "tables/tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::tables {
namespace {

constexpr std::size_t kSteps = 32;
constexpr int kDecimals = 6;

using Row = std::vector<double>;

double share_of(std::size_t i) {
  return static_cast<double>(i) / (kSteps - 1);
}

/// Interpolates a row linearly at s in [0, 1].
double interpolated(const Row& row, double s) {
  const std::size_t first = std::min(static_cast<std::size_t>(s * (kSteps - 1)), kSteps - 2);
  const double share = s * (kSteps - 1) - static_cast<double>(first);
  return row[first] + share * (row[first + 1] - row[first]);
}

/// Returns the cosine-weighted mean of a row. The row is interpolated at s_of(z), and z_of is the
/// inverse function.
template <typename S, typename Z>
double mean(const Row& row, const S& s_of, const Z& z_of) {
  const Quadrature cell = graded(20);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < kSteps; ++i) {
    const double from = z_of(share_of(i)), width = z_of(share_of(i + 1)) - from;
    for (std::size_t k = 0; k < cell.at.size(); ++k) {
      const double z = from + width * cell.at[k];
      sum += width * cell.weights[k] * 2 * z * interpolated(row, s_of(z));
    }
  }
  return sum;
}

void append(std::vector<double>& table, const Row& row) {
  table.insert(table.end(), row.begin(), row.end());
}

}  // namespace

std::string ggx_albedo_table() {
  const Quadrature points = graded(40);
  std::vector<double> white, edge, mean_white, mean_edge;
  for (std::size_t j = 0; j < kSteps; ++j) {
    const double alpha = alpha_of(share_of(j));
    const Alphas alphas{.x = alpha, .y = alpha};
    const auto bent = [&](double z) { return z * (1 + alpha) / (z + alpha); };
    const auto unbent = [&](double s) { return std::min(alpha * s / (1 + alpha - s), 1.0); };
    const auto root = [](double z) { return std::sqrt(z); };
    const auto square = [](double s) { return s * s; };
    Row f1, schlick;
    for (std::size_t i = 0; i < kSteps; ++i) {
      const Direction first = tilted(unbent(share_of(i))), second = tilted(square(share_of(i)));
      f1.push_back(rounded(ggx_albedo(alphas, first, points).f1, kDecimals));
      schlick.push_back(rounded(ggx_albedo(alphas, second, points).schlick, kDecimals));
    }
    append(white, f1);
    append(edge, schlick);
    mean_white.push_back(mean(f1, bent, unbent));
    mean_edge.push_back(mean(schlick, root, square));
  }
  const std::vector<std::size_t> square{kSteps, kSteps}, row{kSteps};
  return header_text(
      "Directional albedos of a GGX reflector with height-correlated masking, the integral over wi "
      "of\n"
      "\n"
      "  F D(h) G2(wo, wi) / (4 wo.z wi.z) wi.z.\n"
      "\n"
      "Entries are rounded integrals. With the interpolation of GgxAlbedo, albedos for F = 1 are " +
          error_text(kGgxF1Error) + ". Albedos for Schlick's term are " +
          error_text(kGgxSchlickError) + ". Means of the interpolated albedos for F = 1 are " +
          error_text(kGgxMeanF1Error) + ". Means for Schlick's term are " +
          error_text(kGgxMeanSchlickError) + ".\n",
      {"array"},
      "inline constexpr int kAlbedoSteps = 32;\n"
      "\n"
      "/// Row j is for roughness r = j / 31 and alpha = max(r^2, 0.001). Columns are angles.\n"
      "using AlbedoTable = std::array<std::array<float, kAlbedoSteps>, kAlbedoSteps>;\n"
      "\n"
      "// clang-format off\n"
      "/// For F = 1. Column i is for i / 31 = mu (1 + alpha) / (mu + alpha) with mu = "
      "cos(theta).\n" +
          table_text("AlbedoTable kAlbedoF1", white, square, kDecimals) +
          "\n/// For F = (1 - cos)^5. Column i is for i / 31 = sqrt(mu).\n" +
          table_text("AlbedoTable kAlbedoSchlick", edge, square, kDecimals) +
          "\n/// The cosine-weighted means of the interpolated albedos, by roughness.\n" +
          table_text("std::array<float, kAlbedoSteps> kMeanAlbedoF1", mean_white, row, kDecimals) +
          table_text("std::array<float, kAlbedoSteps> kMeanAlbedoSchlick", mean_edge, row,
                     kDecimals) +
          "// clang-format on\n");
}

}  // namespace microtrace::tables
