#pragma once
/// Tests shapes other than triangles against all rays of a packet, with the float64 filters.

#include "accel/filters/planar_filter.hpp"
#include "accel/filters/quadratic_filter.hpp"
#include "accel/kernels/kernel.hpp"
#include "accel/kernels/simd.hpp"

namespace microtrace {
namespace {

/// Round to float32, down or up. The numbers must be positive or 0.
template <int N>
inline Float<N> rounded_down(const Double<N>& x) {
  const Float<N> f = to_single<N>(x);
  return single_mask<N>(to_double<N>(f) > x) ? moved_by_ulps<N>(f, -1) : f;
}
template <int N>
inline Float<N> rounded_up(const Double<N>& x) {
  const Float<N> f = to_single<N>(x);
  return single_mask<N>(to_double<N>(f) < x) ? moved_by_ulps<N>(f, 1) : f;
}

template <int N>
inline void store_doubles(Lanes lanes, const Double<N>& v, double* p) {
  double values[N];
  __builtin_memcpy(values, &v, sizeof v);
  for (; lanes != 0; lanes &= lanes - 1) p[first_lane(lanes)] = values[first_lane(lanes)];
}

/// See ShapeKernels.
template <int N, class Seen>
std::uint64_t consider_shape(const Seen& shape, std::uint32_t id, KernelPacket& packet,
                             ShapeBounds& found) {
  std::uint64_t open = 0;
  for (int i = 0; i < packet.count; i += N) {
    const Doubles3<N> d = widened3<N>(packet.d, i);
    const Ranges<N> range{widened<N>(packet.t_min + i), widened<N>(found.t_max + i)};
    const FilterResults<N> result = filter<N>(shape, d, range);
    const Double<N> best_lo = widened<N>(packet.best_lo + i),
                    best_hi = widened<N>(packet.best_hi + i);
    const RayMask<N> meets = negated(result.miss) & (result.lo <= best_hi);
    const Lanes met = true_double_lanes<N>(meets);
    if (met == 0) continue;
    const Lanes nearer = true_double_lanes<N>(meets & result.hit & (result.hi < best_lo));
    open |= std::uint64_t{met & ~nearer} << i;
    if (nearer == 0) continue;
    const Float<N> lo = rounded_down<N>(result.lo), hi = rounded_up<N>(result.hi);
    store<N>(packet.best_lo + i, select<N>(nearer, lo, load<N>(packet.best_lo + i)));
    store<N>(packet.best_hi + i, select<N>(nearer, hi, load<N>(packet.best_hi + i)));
    store_where<N>(nearer, id, packet.best_id + i);
    store_where<N>(nearer, PacketHits::kNone, packet.best_index + i);
    store_where<N>(nearer, id, found.id + i);
    store_doubles<N>(nearer, result.lo, found.lo + i);
    store_doubles<N>(nearer, result.hi, found.hi + i);
  }
  const int unused = kPacketRays - packet.count;
  return open << unused >> unused;
}

template <int N>
constexpr ShapeKernels kShapeKernels{consider_shape<N>, consider_shape<N>, consider_shape<N>,
                                     consider_shape<N>};

}  // namespace
}  // namespace microtrace
