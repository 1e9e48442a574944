#include "render/bsdf/tables/tables.hpp"

#include "render/bsdf/tables/anisotropic_schlick_table.hpp"
#include "render/bsdf/tables/coating_schlick_table.hpp"
#include "render/bsdf/tables/refraction_loss_within_table.hpp"

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

constexpr DeficitByRow kDeficitF1ByRow = by_row(kDeficitF1);
constexpr DeficitByRow kDeficitSchlickByRow = by_row(kDeficitSchlick);

}  // namespace

constinit const Tables kTables{
    .albedo_f1 = kAlbedoF1[0].data(),
    .albedo_schlick = kAlbedoSchlick[0].data(),
    .mean_albedo_f1 = kMeanAlbedoF1.data(),
    .mean_albedo_schlick = kMeanAlbedoSchlick.data(),
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
    .raw_sheen_albedo = kRawSheenAlbedo[0].data(),
    .sheen_albedo = kSheenAlbedo[0].data(),
};

}  // namespace microtrace::bsdf
