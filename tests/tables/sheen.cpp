#include "tables/albedos.hpp"
#include "tables/header_text.hpp"
#include "tables/stated_errors.hpp"
#include "tables/tables.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace microtrace::tables {
namespace {

constexpr std::size_t kRows = 20, kColumns = 32;
constexpr int kDecimals = 4;

double place(std::size_t i, std::size_t size) {
  return static_cast<double>(i) / static_cast<double>(size - 1);
}

/// Returns cos(theta) for s in [0, 1]. Column i of the table has s = i / 31, and b is roughness /
/// 2.
double cosine_at(double s, double b) {
  return std::min(b * s / (1 + b - s), 1.0);
}

using Row = std::vector<double>;

/// Returns the albedo of the published model. It has a maximum in the first columns and diverges
/// very near the horizon. The albedo is used as a divisor, so the entries before the maximum are
/// set to the maximum.
Row raw_row(double roughness) {
  const Sheen sheen(roughness);
  const Quadrature points = graded(64);
  Row result(kColumns);
  for (std::size_t i = kColumns; i-- > 1;) {
    const double there = sheen.albedo(cosine_at(place(i, kColumns), roughness / 2), points);
    result[i] = rounded(i + 1 < kColumns ? std::max(there, result[i + 1]) : there, kDecimals);
  }
  result[0] = result[1];
  return result;
}

/// Returns the albedo of the divided model at s. The published model is divided by the larger of
/// the entries of `raw` for wo and wi, or by 1 if both are smaller.
double scaled_albedo(double roughness, const Row& raw, double s) {
  const Sheen sheen(roughness);
  const Quadrature azimuths = graded(32), cell = graded(12);
  const double b = roughness / 2, z = cosine_at(s, b);
  const auto raw_at = [&](std::size_t i, double share) {
    return raw[i] + share * (raw[i + 1] - raw[i]);
  };
  const double step = s * (kColumns - 1);
  const std::size_t column = std::min(static_cast<std::size_t>(step), kColumns - 2);
  const double here = raw_at(column, step - static_cast<double>(column));
  double sum = 0;
  for (std::size_t i = 0; i + 1 < kColumns; ++i) {
    for (std::size_t k = 0; k < cell.at.size(); ++k) {
      const double t = (static_cast<double>(i) + cell.at[k]) / (kColumns - 1);
      const double z_in = cosine_at(t, b);
      // dz / dt per column
      const double slope = b * (1 + b) / ((1 + b - t) * (1 + b - t)) / (kColumns - 1);
      const double most = std::max({here, raw_at(i, cell.at[k]), 1.0});
      const double masking = 1 + sheen.lambda(z) + sheen.lambda(z_in);
      sum += cell.weights[k] * slope * z_in * sheen.around(z, z_in, masking, azimuths) / most;
    }
  }
  return sum;
}

Row scaled_row(double roughness, const Row& raw) {
  Row result(kColumns);
  for (std::size_t i = 1; i < kColumns; ++i)
    result[i] = scaled_albedo(roughness, raw, place(i, kColumns));
  // Makes the interpolated value in the middle of the first cell exact.
  result[0] = 2 * scaled_albedo(roughness, raw, 0.5 / (kColumns - 1)) - result[1];
  return result;
}

}  // namespace

std::string sheen_table() {
  std::vector<double> raw, scaled;
  for (std::size_t j = 0; j < kRows; ++j) {
    const double root = place(j, kRows), roughness = 0.05 + 0.95 * root * root;
    const Row published = raw_row(roughness), divided = scaled_row(roughness, published);
    raw.insert(raw.end(), published.begin(), published.end());
    scaled.insert(scaled.end(), divided.begin(), divided.end());
  }
  const std::vector<std::size_t> sizes{kRows, kColumns};
  std::string most = number_text(kMostSheen, 2);
  most.pop_back();  // the suffix F
  return header_text(
      "Directional albedos of sheen, the integral over wi of\n"
      "\n"
      "  D(h) / (4 (1 + lambda(wo.z) + lambda(wi.z)) wo.z wi.z) wi.z,\n"
      "  D(h) = (2 + 1 / alpha) sin(theta_h)^(1 / alpha) / (2 pi),   alpha = r^2,\n"
      "\n"
      "with lambda as in A. Conty Estevez and C. Kulla, Production friendly microfacet sheen BRDF, "
      "2017.\n"
      "\n"
      "With the interpolation of SheenLobe, albedos are " +
          error_text(kSheenError) + ". The integral is at most " + most + ".\n",
      {"array", "cstddef"},
      "inline constexpr std::size_t kSheenRows = 20, kSheenColumns = 32;\n"
      "\n"
      "/// Row j is for roughness r = 0.05 + 0.95 (j / 19)^2. Column i is for z = cos(theta) with\n"
      "/// z (1 + b) / (z + b) = i / 31 and b = r / 2.\n"
      "using SheenTable = std::array<std::array<float, kSheenColumns>, kSheenRows>;\n"
      "\n"
      "// clang-format off\n"
      "\n"
      "/// The albedo of the published model. Columns closer to the horizon than the maximum "
      "repeat the\n"
      "/// maximum.\n" +
          table_text("SheenTable kRawSheenAlbedo", raw, sizes, kDecimals) +
          "\n/// The albedo of the model divided by kRawSheenAlbedo for wo or wi, whichever is "
          "larger, where\n"
          "/// this divisor exceeds 1.\n" +
          table_text("SheenTable kSheenAlbedo", scaled, sizes, kDecimals) +
          "\n// clang-format on\n");
}

}  // namespace microtrace::tables
