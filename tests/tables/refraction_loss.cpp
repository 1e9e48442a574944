#include "tables/albedos.hpp"
#include "tables/fit.hpp"
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

constexpr std::size_t kIndices = 8, kRows = 12, kColumns = 17;
constexpr double kGreatestCritical = 0.96, kUnit = 1e-4, kSlopeUnit = 1e-3;
constexpr double kPenalty = 33;

/// Returns positions from `from` to nodes - 1, with `per_node` positions for each node.
std::vector<double> positions(double from, std::size_t nodes, std::size_t per_node) {
  std::vector<double> result;
  for (std::size_t i = 0; i <= (nodes - 1) * per_node; ++i) {
    const double at = static_cast<double>(i) / static_cast<double>(per_node);
    if (at > from) result.push_back(at);
  }
  result.insert(result.begin(), from);
  return result;
}

/// Returns the matrix of interpolation by the parabola through the three nearest nodes. It has a
/// row for each position.
Factors parabolas(const std::vector<double>& at, std::size_t nodes) {
  std::vector<double> matrix(at.size() * nodes);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto nearest = static_cast<std::size_t>(at[i] + 0.5);
    const std::size_t first = std::min(std::max(nearest, std::size_t{1}) - 1, nodes - 3);
    const double p = at[i] - static_cast<double>(first);
    double* row = &matrix[i * nodes + first];
    row[0] = (p - 1) * (p - 2) / 2;
    row[1] = p * (2 - p);
    row[2] = p * (p - 1) / 2;
  }
  return {matrix, nodes};
}

/// Returns the matrix of linear interpolation.
Factors lines(const std::vector<double>& at, std::size_t nodes) {
  std::vector<double> matrix(at.size() * nodes);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::size_t first = std::min(static_cast<std::size_t>(at[i]), nodes - 2);
    const double p = at[i] - static_cast<double>(first);
    matrix[i * nodes + first] = 1 - p;
    matrix[i * nodes + first + 1] = p;
  }
  return {matrix, nodes};
}

double square(double x) {
  return x * x;
}

double cosine_outside(double column) {
  return square(column / (kColumns - 1));
}

double cosine_within(double column, double critical) {
  constexpr double half = (kColumns - 1) / 2.0;
  if (column < half) return critical * square(column / half);
  return critical + (1 - critical) * square((column - half) / half);
}

/// The losses at the places for which the tables are fitted.
class Samples {
 public:
  /// For light from the denser side if `within` is true, otherwise from the thinner side.
  explicit Samples(bool within) {
    const Quadrature points = graded(24);
    for (const double index : indices_) {
      const double critical = kGreatestCritical * index / (kIndices - 1);
      const double inverse = std::sqrt(1 - critical * critical);
      for (const double row : rows_) {
        const double alpha = alpha_of(row / (kRows - 1));
        for (const double column : columns_) {
          const double z = within ? cosine_within(column, critical) : cosine_outside(column);
          losses_.push_back(refraction_loss(alpha, z, within ? inverse : 1 / inverse, points));
        }
      }
    }
  }

  /// The entries of the table for the losses, which are rarely too large.
  [[nodiscard]] std::string losses_text(const std::string& name) const {
    return text(name, low_fit(axes(), values(&RefractionLoss::loss), kPenalty), kUnit);
  }
  /// The entries of a table for a derivative.
  [[nodiscard]] std::string slopes_text(const std::string& name,
                                        double RefractionLoss::*slope) const {
    return text(name, fit(axes(), values(slope)), kSlopeUnit);
  }

 private:
  [[nodiscard]] std::vector<Factors> axes() const {
    return {parabolas(indices_, kIndices), parabolas(rows_, kRows), lines(columns_, kColumns)};
  }
  [[nodiscard]] std::vector<double> values(double RefractionLoss::*part) const {
    std::vector<double> result;
    for (const RefractionLoss& loss : losses_) result.push_back(loss.*part);
    return result;
  }
  [[nodiscard]] static std::string text(const std::string& name, std::vector<double> entries,
                                        double unit) {
    for (double& entry : entries) entry /= unit;
    return table_text("RefractionLossTable " + name, entries, {kIndices, kRows, kColumns}, 0);
  }

  // 0.56 is the position of the index 1.003, the smallest one that refracts.
  std::vector<double> indices_ = positions(0.56, kIndices, 3), rows_ = positions(0, kRows, 3),
                      columns_ = positions(0, kColumns, 3);
  std::vector<RefractionLoss> losses_;
};

std::string slopes_header(const std::string& comment, bool within, const std::string& suffix) {
  const Samples samples(within);
  return header_text(comment, {"render/bsdf/tables/refraction_loss_table.hpp"},
                     "// clang-format off\n"
                     "\n"
                     "/// The derivative by f0.\n" +
                         samples.slopes_text("kLossByF0" + suffix, &RefractionLoss::by_f0) +
                         "\n/// The derivative by f90.\n" +
                         samples.slopes_text("kLossByF90" + suffix, &RefractionLoss::by_f90) +
                         "\n// clang-format on\n");
}

}  // namespace

std::string refraction_loss_table() {
  return header_text(
      "Energy deficit of single scattering at a rough refracting boundary, 1 minus the integral "
      "over h of\n"
      "\n"
      "  D(h) (wo . h) / wo.z (F G2(wo, reflected) + (1 - F) min(G1(wo), G1(refracted))).\n"
      "\n"
      "F is Schlick's Fresnel term that follows from the index of refraction, for the cosine in "
      "the thinner medium. Entries are fitted so that the interpolation of RefractionLoss is "
      "rarely above the integral. From the thinner side, losses are " +
          error_text(kLossOutsideError) + ". From the denser side, losses are " +
          error_text(kLossWithinError) + ". The greatest errors are at cos(theta) < 0.03.\n",
      {"array", "cstddef", "cstdint"},
      "inline constexpr std::size_t kLossIndices = 8, kLossRows = 12, kLossColumns = 17;\n"
      "inline constexpr float kGreatestCritical = 0.96F;  ///< greatest cosine of a critical "
      "angle\n"
      "inline constexpr float kRefractionUnit = 1 / 10000.0F;\n"
      "inline constexpr float kSlopeUnit = 1 / 1000.0F;  ///< of refraction_slopes_table.hpp\n"
      "\n"
      "/// Entry [k][j][i] is for cos(critical angle) = 0.96 k / 7, roughness j / 11 and angle i, "
      "in\n"
      "/// units of kRefractionUnit.\n"
      "using RefractionLossTable =\n"
      "    std::array<std::array<std::array<std::int16_t, kLossColumns>, kLossRows>, "
      "kLossIndices>;\n"
      "\n"
      "// clang-format off\n"
      "\n"
      "/// For light from the thinner side. Column i is for cos(theta) = (i / 16)^2.\n" +
          Samples(false).losses_text("kLossFromOutside") + "\n// clang-format on\n");
}

std::string refraction_loss_within_table() {
  return header_text(
      "The counterpart of kLossFromOutside in refraction_loss_table.hpp for light from the denser "
      "side.\n",
      {"render/bsdf/tables/refraction_loss_table.hpp"},
      "// clang-format off\n"
      "\n"
      "/// c is the cosine of the critical angle. Columns 0 to 8 are for cos(theta) = c (i / "
      "8)^2,\n"
      "/// columns 8 to 16 for cos(theta) = c + (1 - c) ((i - 8) / 8)^2.\n" +
          Samples(true).losses_text("kLossFromWithin") + "\n// clang-format on\n");
}

std::string refraction_slopes_table() {
  return slopes_header(
      "Derivatives of kLossFromOutside in refraction_loss_table.hpp by f0 and f90 of Schlick's "
      "Fresnel term. The loss is a linear function of both. For f0 <= f90 <= 1, losses are " +
          error_text(kAnyLossOutsideError) + ".\n",
      false, "FromOutside");
}

std::string refraction_slopes_within_table() {
  return slopes_header(
      "Derivatives of kLossFromWithin in refraction_loss_within_table.hpp, as in "
      "refraction_slopes_table.hpp. For f0 <= f90 <= 1, losses are " +
          error_text(kAnyLossWithinError) + ".\n",
      true, "FromWithin");
}

}  // namespace microtrace::tables
