#pragma once
/// The kernels of all instruction sets. Not to be included by the kernels' own translation units.

#include "scene/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<SceneKernels> kSceneKernels =
    MICROTRACE_KERNEL_TABLES(kPortableScene, kAvx2Scene, kAvx512Scene);

}  // namespace microtrace
