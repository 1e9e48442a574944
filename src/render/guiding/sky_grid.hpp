#pragma once
/// Finds the cells of SkyVisibility, for N lanes.

#include "render/guiding/hemisphere_lanes.hpp"

#include <cstdint>

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// Finds the cells for N surfaces at points p with unit normals n.
template <int N, int width>
void find_sky_cells_from(const SkyGrid& grid, const float (&p)[3][width],
                         const float (&n)[3][width], std::uint32_t (&cells)[width], int i) {
  using D = Double<N>;
  Int<N> index = nearest_face<N>(load3<N>(n, i));
  for (int axis = 0; axis < 3; ++axis) {
    const D zero{}, last = zero + (grid.size[axis] - 1);
    const D place = (widened<N>(p[axis] + i) - grid.low[axis]) / grid.cell_size;
    index = index * grid.size[axis] + truncated_to_int<N>(smaller_of(larger_of(zero, place), last));
  }
  __builtin_memcpy(cells + i, &index, sizeof index);
}

template <int N, int width>
void find_sky_cells(const SkyGrid& grid, const float (&p)[3][width], const float (&n)[3][width],
                    std::uint32_t (&cells)[width]) {
  for (int i = 0; i < width; i += kDoubleLanes<N>)
    find_sky_cells_from<kDoubleLanes<N>>(grid, p, n, cells, i);
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
