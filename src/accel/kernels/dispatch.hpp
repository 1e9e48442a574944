#pragma once
/// The kernels for all instruction sets. The kernels' own translation units must not include this
/// header.

#include "accel/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<Kernels> kRayKernels =
    MICROTRACE_KERNEL_TABLES(kPortableKernels, kAvx2Kernels, kAvx512Kernels);

}  // namespace microtrace
