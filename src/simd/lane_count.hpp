#pragma once
#include "simd/vector_types.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// The number of lanes. The compiler's baseline for x86 has no instruction for it, so std::popcount
/// would call a function.
constexpr int lane_count(Lanes lanes) {
#if defined(__POPCNT__)
  return __builtin_popcount(lanes);
#else
  lanes -= lanes >> 1U & 0x55555555U;
  lanes = (lanes & 0x33333333U) + (lanes >> 2U & 0x33333333U);
  lanes = (lanes + (lanes >> 4U)) & 0x0f0f0f0fU;
  return static_cast<int>(lanes * 0x01010101U >> 24U);
#endif
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
