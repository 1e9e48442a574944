#pragma once
/// Input and output of the kernels that guide paths. Contains only plain data; see
/// shading_kernels.hpp.

#include <cstdint>

namespace microtrace {

/// The bins of HemisphereLanes.
struct HemisphereGrid {
  static constexpr int kRows = 12, kColumns = 24, kCount = kRows * kColumns;
};

/// The grid of a SkyVisibility. It has one layer of cells for each of the six faces of a cube
/// toward which surfaces face; see nearest_face().
struct SkyGrid {
  double low[3];  ///< corner of the first cell
  double cell_size;
  std::int32_t size[3];  ///< number of cells on each axis
};

/// A pdf of directions on the hemisphere about a coordinate axis: constant within each bin of
/// HemisphereLanes, or within each of kParts parts of the bins from which much of the light
/// arrives. Probabilities are multiples of 1 / kSlots.
struct GuideTable {
  static constexpr int kSlots = 512, kBins = HemisphereGrid::kCount;
  static constexpr int kEdge = 4, kParts = kEdge * kEdge;
  static constexpr std::uint32_t kWhole = kParts;  ///< see GuideSlot
  static constexpr std::uint16_t kFine = 0x8000;
  using Parts = std::uint16_t[kParts];

  std::int32_t axis = 2;  ///< 0 to 2
  float sign = 1;         ///< -1 for the negative direction of the axis
  /// The number of slots that select each bin; kFine plus an index into `fine` for those in parts.
  /// The last one is 0.
  std::uint16_t counts[kBins + 1] = {};
  const Parts* fine = nullptr;       ///< the numbers of slots that select each part
  std::uint32_t slots[kSlots] = {};  ///< GuideSlot::packed() of equally probable parts
};

/// Directions that are sampled from tables.
template <int width>
struct alignas(64) GuideLanes {
  const GuideTable* tables[width];  ///< null only if there is nothing to sample
  float u[2][width];                ///< random numbers in [0, 1)
  float wi[3][width];               ///< unit directions; set by sample_guides()
  float pdf[width];                 ///< of wi, per steradian; set by guide_pdfs()
};

}  // namespace microtrace
