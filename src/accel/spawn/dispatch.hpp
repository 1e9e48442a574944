#pragma once
/// The kernels for all instruction sets. The kernels' own translation units must not include this
/// header.

#include "accel/spawn/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

/// Kernels for the origins of rays that leave surfaces.
inline constexpr KernelTables<SpawnKernels> kSpawnKernels =
    MICROTRACE_KERNEL_TABLES(kPortableSpawn, kAvx2Spawn, kAvx512Spawn);

}  // namespace microtrace
