#pragma once
/// Transposes the rays of a stream, and prepares them for traversal.

#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"
#include "accel/kernels/slabs.hpp"
#include "simd/transpose.hpp"

namespace microtrace {
namespace {

template <int N>
void read_stream(const float* rays, KernelStream& stream) {
  for (int i = 0; i < stream.count; i += N) {
    std::uint32_t row[N];
    for (int lane = 0; lane < N; ++lane)
      row[lane] = static_cast<std::uint32_t>(i + lane < stream.count ? i + lane : stream.count - 1);
    Float<N> column[8];
    load_rows<N>(rays, row, column);
    for (int axis = 0; axis < 3; ++axis) {
      store<N>(stream.o[axis] + i, column[axis]);
      store<N>(stream.d[axis] + i, column[4 + axis]);
    }
    store<N>(stream.t_min + i, column[3]);
    store<N>(stream.best_hi + i, column[7]);
  }
}

template <int N>
void prepare_stream(KernelStream& stream) {
  using F = Float<N>;
  const F zero{}, one = all<N>(1.0F), farthest = all<N>(kFarthestCoordinate);
  for (int i = 0; i < stream.count; i += N) {
    F t_min = load<N>(stream.t_min + i), t_max = load<N>(stream.best_hi + i), size{};
    Lanes suited =
        less_equal<N>(zero, t_min) & less_equal<N>(t_min, farthest) & less_equal<N>(t_min, t_max);
    for (int axis = 0; axis < 3; ++axis) {
      const F length = magnitude(load<N>(stream.d[axis] + i));
      size = greater(length, size);
      suited &= less_equal<N>(length, all<N>(kLongestDirection)) &
                less_equal<N>(magnitude(load<N>(stream.o[axis] + i)), farthest);
    }
    suited &= less_equal<N>(all<N>(kShortestDirection), size);
    F sum{};
    for (int axis = 0; axis < 3; ++axis) {
      F d = load<N>(stream.d[axis] + i), near, far;
      if (suited != kAllLanes<N>) {
        d = select<N>(suited, d, one);
        store<N>(stream.d[axis] + i, d);
        store<N>(stream.o[axis] + i, select<N>(suited, load<N>(stream.o[axis] + i), zero));
      }
      slab_factors<N>(d, near, far);
      store<N>(stream.near[axis] + i, near);
      store<N>(stream.far[axis] + i, far);
      sum = sum + magnitude(d);
    }
    t_min = select<N>(suited, t_min, zero);
    t_max = select<N>(suited, t_max, zero);
    store<N>(stream.d_sum + i, sum * (1 + 0x1p-21F));
    store<N>(stream.t_min + i, t_min);
    store<N>(stream.t_begin + i, t_min < all<N>(kLeastBegin) ? zero : t_min);
    store<N>(stream.best_lo + i, t_max);
    store<N>(stream.best_hi + i, t_max);
    for (int lane = 0; lane < N; ++lane) stream.best_id[i + lane] = kNoPrimitive;
    const int shift = i % 64;
    std::uint64_t& set = stream.suited[i / 64];
    set = (shift == 0 ? 0 : set) | std::uint64_t{suited} << shift;
  }
  // Fills the last packet by repeating the last ray.
  for (int i = stream.count; i % kPacketRays != 0; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      stream.o[axis][i] = stream.o[axis][i - 1];
      stream.d[axis][i] = stream.d[axis][i - 1];
    }
    stream.best_hi[i] = stream.best_hi[i - 1];
    stream.omitted_id[i] = stream.omitted_id[i - 1];
    stream.best_id[i] = kNoPrimitive;
  }
}

}  // namespace
}  // namespace microtrace
