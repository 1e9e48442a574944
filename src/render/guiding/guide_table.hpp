#pragma once
/// Pdfs of directions on hemispheres, for N lanes.

#include "render/guiding/hemisphere_lanes.hpp"
#include "render/lanes/guide_lanes.hpp"
#include "simd/vectors.hpp"

#include <cstdint>
#include <numbers>

namespace microtrace {

/// The part of a bin that a slot of a GuideTable selects.
struct GuideSlot {
  std::uint32_t bin;
  std::uint32_t part;  ///< GuideTable::kWhole for the whole bin
  std::uint32_t rank;  ///< number of the slot among the `count` slots of the part
  std::uint32_t count;

  [[nodiscard]] std::uint32_t packed() const {
    return bin | part << 9U | rank << 14U | (count - 1) << 23U;
  }
};

inline namespace MICROTRACE_KERNELS {

/// The pdf of one slot of a whole bin.
inline constexpr auto kGuideSlotPdf =
    static_cast<float>(GuideTable::kBins / (2 * std::numbers::pi * GuideTable::kSlots));

template <int N>
HemisphereLanes<N> guide_hemispheres(const GuideTable* const* tables) {
  alignas(64) float axis[N], sign[N];
  for (int k = 0; k < N; ++k) {
    axis[k] = static_cast<float>(tables[k]->axis);
    sign[k] = tables[k]->sign;
  }
  return {.axis = truncated<N>(load<N>(axis)), .sign = load<N>(sign)};
}

template <int N, int width>
void sample_guides_from(GuideLanes<width>& lanes, int i) {
  using F = Float<N>;
  using I = Int<N>;
  const GuideTable* const* tables = lanes.tables + i;
  const F number = load<N>(lanes.u[0] + i) * GuideTable::kSlots;
  const I slot = truncated<N>(number);
  alignas(64) std::int32_t indices[N];
  __builtin_memcpy(indices, &slot, sizeof indices);
  alignas(64) std::uint32_t packed[N];
  for (int k = 0; k < N; ++k) packed[k] = tables[k]->slots[indices[k]];
  const Unsigned<N> bits = load_bits<N>(packed);
  const auto field = [&](unsigned shift, std::uint32_t most) {
    return reinterpreted<I>(Unsigned<N>(bits >> shift & most));
  };
  const I bin = field(0, 511), part = field(9, 31);
  const F rank = to_float<N>(field(14, 511)), count = to_float<N>(I(field(23, 511) + 1));
  const F along =
      smaller_of(F((rank + (number - to_float<N>(slot))) / count), all<N>(0x1.fffffep-1F));
  const F across = load<N>(lanes.u[1] + i);
  const auto is_whole = part == GuideTable::kWhole;
  const F edge = all<N>(1.0F / GuideTable::kEdge);
  const F row = is_whole ? along : (to_float<N>(I(part >> 2)) + along) * edge;
  const F column = is_whole ? across : (to_float<N>(I(part & 3)) + across) * edge;
  static_assert(GuideTable::kEdge == 4 && HemisphereGrid::kColumns == 24);
  const I line = bin * 2731 >> 16;  // bin / 24
  store3<N>(
      lanes.wi, i,
      guide_hemispheres<N>(tables).direction(
          to_float<N>(line) + row, to_float<N>(I(bin - line * HemisphereGrid::kColumns)) + column));
}

/// Samples directions for all lanes.
template <int N, int width>
void sample_guides(GuideLanes<width>& lanes) {
  for (int i = 0; i < width; i += N) sample_guides_from<N>(lanes, i);
}

template <int N, int width>
void guide_pdfs_from(GuideLanes<width>& lanes, int i) {
  using F = Float<N>;
  using I = Int<N>;
  const GuideTable* const* tables = lanes.tables + i;
  const auto place = guide_hemispheres<N>(tables).place(load3<N>(lanes.wi, i));
  const auto within = [](const F& x) {
    return smaller_of(truncated<N>(F(x * GuideTable::kEdge)), I{} + (GuideTable::kEdge - 1));
  };
  const I part = within(place.row) * GuideTable::kEdge + within(place.column);
  alignas(64) std::int32_t bins[N], parts[N];
  __builtin_memcpy(bins, &place.bin, sizeof bins);
  __builtin_memcpy(parts, &part, sizeof parts);
  alignas(64) float slots[N];
  for (int k = 0; k < N; ++k) {
    const GuideTable& table = *tables[k];
    // Directions below the hemisphere are in the bin after the last one, which has no slots.
    std::uint32_t count = table.counts[bins[k] < 0 ? GuideTable::kBins : bins[k]];
    if (count >= GuideTable::kFine)
      count = GuideTable::kParts * table.fine[count - GuideTable::kFine][parts[k]];
    slots[k] = static_cast<float>(count);
  }
  store<N>(lanes.pdf + i, load<N>(slots) * kGuideSlotPdf);
}

/// Computes the pdfs of the directions of all lanes.
template <int N, int width>
void guide_pdfs(GuideLanes<width>& lanes) {
  for (int i = 0; i < width; i += N) guide_pdfs_from<N>(lanes, i);
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
