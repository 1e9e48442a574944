#include "render/bsdf/tables/tables.hpp"

#include "render/bsdf/tables/anisotropic_schlick_table.hpp"
#include "render/bsdf/tables/coating_schlick_table.hpp"
#include "render/bsdf/tables/refraction_loss_within_table.hpp"
#include "render/bsdf/tables/refraction_slopes_table.hpp"
#include "render/bsdf/tables/refraction_slopes_within_table.hpp"

namespace microtrace::bsdf {

namespace {

/// The entries of a column and a node, for all rows.
struct alignas(64) RowEntries {
  std::array<float, kPaddedRows> values{};
};
using DeficitByRow = std::array<std::array<RowEntries, kCoatingNodes>, kCoatingColumns>;

constexpr DeficitByRow by_row(const DeficitTable& table) {
  DeficitByRow result{};
  for (std::size_t row = 0; row < kCoatingRows; ++row) {
    for (std::size_t column = 0; column < kCoatingColumns; ++column) {
      for (std::size_t node = 0; node < kCoatingNodes; ++node)
        result[column][node].values[row] = table[row][column][node];
    }
  }
  return result;
}

/// Four entries that are loaded at once.
struct alignas(16) Quad {
  std::array<float, 4> values{};
};

/// The entries at the corners of each cell of a table: in row j, those of the columns i and i + 1,
/// then those in row j + 1.
template <std::size_t rows, std::size_t columns>
constexpr auto cells_of(const std::array<std::array<float, columns>, rows>& table) {
  std::array<std::array<Quad, columns - 1>, rows - 1> cells{};
  for (std::size_t j = 0; j + 1 < rows; ++j) {
    for (std::size_t i = 0; i + 1 < columns; ++i)
      cells[j][i].values = {table[j][i], table[j][i + 1], table[j + 1][i], table[j + 1][i + 1]};
  }
  return cells;
}

constexpr auto mean_albedos_of_pairs() {
  std::array<Quad, kAlbedoSteps - 1> pairs{};
  for (std::size_t j = 0; j < pairs.size(); ++j) {
    pairs[j].values = {kMeanAlbedoF1[j], kMeanAlbedoF1[j + 1], kMeanAlbedoSchlick[j],
                       kMeanAlbedoSchlick[j + 1]};
  }
  return pairs;
}

constexpr auto kAlbedoF1Cells = cells_of(kAlbedoF1);
constexpr auto kAlbedoSchlickCells = cells_of(kAlbedoSchlick);
constexpr auto kMeanAlbedos = mean_albedos_of_pairs();
constexpr auto kRawSheenCells = cells_of(kRawSheenAlbedo);
constexpr auto kSheenCells = cells_of(kSheenAlbedo);

constexpr DeficitByRow kDeficitF1ByRow = by_row(kDeficitF1);
constexpr DeficitByRow kDeficitSchlickByRow = by_row(kDeficitSchlick);

}  // namespace

constinit const Tables kTables{
    .albedo_f1 = kAlbedoF1Cells[0][0].values.data(),
    .albedo_schlick = kAlbedoSchlickCells[0][0].values.data(),
    .mean_albedos = kMeanAlbedos[0].values.data(),
    .anisotropic_loss = kAnisotropicLoss[0][0][0].data(),
    .anisotropic_schlick = kAnisotropicSchlick[0][0][0].data(),
    .mean_anisotropic_loss = kMeanAnisotropicLoss[0].data(),
    .mean_anisotropic_schlick = kMeanAnisotropicSchlick[0].data(),
    .coating_node = kCoatingNode.data(),
    .coating_weight = kCoatingWeight.data(),
    .deficit_f1 = kDeficitF1ByRow[0][0].values.data(),
    .deficit_schlick = kDeficitSchlickByRow[0][0].values.data(),
    .loss_from_outside = kLossFromOutside[0][0].data(),
    .loss_from_within = kLossFromWithin[0][0].data(),
    .loss_by_f0_from_outside = kLossByF0FromOutside[0][0].data(),
    .loss_by_f90_from_outside = kLossByF90FromOutside[0][0].data(),
    .loss_by_f0_from_within = kLossByF0FromWithin[0][0].data(),
    .loss_by_f90_from_within = kLossByF90FromWithin[0][0].data(),
    .raw_sheen_albedo = kRawSheenCells[0][0].values.data(),
    .sheen_albedo = kSheenCells[0][0].values.data(),
};

}  // namespace microtrace::bsdf
