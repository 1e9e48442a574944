#pragma once
/// The tables of albedos as plain pointers, because kernels must not instantiate templates of the
/// standard library (simd/vectors.hpp).

#include "render/bsdf/tables/anisotropic_loss_table.hpp"
#include "render/bsdf/tables/coating_table.hpp"
#include "render/bsdf/tables/ggx_albedo_table.hpp"
#include "render/bsdf/tables/refraction_loss_table.hpp"
#include "render/bsdf/tables/sheen_table.hpp"

#include <cstdint>

namespace microtrace::bsdf {

inline constexpr int kPaddedRows = 16;

struct Tables {
  // GGX: the cells of tables with kAlbedoSteps rows and columns. For each pair of rows, their means
  // for F = 1, then those for Schlick's term.
  const float *albedo_f1, *albedo_schlick, *mean_albedos;
  // Anisotropic GGX: polynomial coefficients.
  const float *anisotropic_loss, *anisotropic_schlick;
  const float *mean_anisotropic_loss, *mean_anisotropic_schlick;
  // Coatings: nodes and their weights; for each of kCoatingColumns columns and kCoatingNodes nodes,
  // the entries of kCoatingRows rows, filled up to kPaddedRows.
  const float *coating_node, *coating_weight;
  const float *deficit_f1, *deficit_schlick;
  // Refraction: for each index of refraction, kLossRows rows of kLossColumns entries.
  const std::int16_t *loss_from_outside, *loss_from_within;
  const std::int16_t *loss_by_f0_from_outside, *loss_by_f90_from_outside;
  const std::int16_t *loss_by_f0_from_within, *loss_by_f90_from_within;
  // Sheen: the cells of tables with kSheenColumns columns.
  const float *raw_sheen_albedo, *sheen_albedo;
};

extern const Tables kTables;

}  // namespace microtrace::bsdf
