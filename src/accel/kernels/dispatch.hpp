#pragma once
/// The kernels for all instruction sets. The kernels' own translation units must not include this
/// header.

#include "accel/kernels/kernel.hpp"
#include "accel/spawn/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<Kernels> kRayKernels =
    MICROTRACE_KERNEL_TABLES(kPortableKernels, kAvx2Kernels, kAvx512Kernels);

/// Kernels for the origins of rays that leave surfaces.
inline constexpr KernelTables<SpawnKernels> kSpawnKernels =
    MICROTRACE_KERNEL_TABLES(kPortableSpawn, kAvx2Spawn, kAvx512Spawn);

}  // namespace microtrace
