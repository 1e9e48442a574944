#pragma once
/// Declares the shading kernels of all instruction sets. The kernels' own translation units must
/// not include this header.

#include "render/lanes/shading_kernels.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<ShadingKernels> kShadingKernels =
    MICROTRACE_KERNEL_TABLES(kPortableShading, kAvx2Shading, kAvx512Shading);

}  // namespace microtrace
