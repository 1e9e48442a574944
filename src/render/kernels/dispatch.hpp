#pragma once
/// The shading kernels of all instruction sets. Not to be included by the kernels' own translation
/// units.

#include "render/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<ShadingKernels> kShadingKernels =
    MICROTRACE_KERNEL_TABLES(kPortableShading, kAvx2Shading, kAvx512Shading);

}  // namespace microtrace
