#pragma once
/// The kernels of all instruction sets. Not to be included by the kernels' own translation units.

#include "accel/kernels/kernel.hpp"
#include "accel/spawn/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<Kernels> kRayKernels =
    MICROTRACE_KERNEL_TABLES(kPortableKernels, kAvx2Kernels, kAvx512Kernels);

/// For rays that leave surfaces.
inline constexpr KernelTables<SpawnKernels> kSpawnKernels =
    MICROTRACE_KERNEL_TABLES(kPortableSpawn, kAvx2Spawn, kAvx512Spawn);

}  // namespace microtrace
