#pragma once
/// Declares the kernels of all instruction sets. The kernels' own translation units must not
/// include this header.

#include "scene/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<SceneKernels> kSceneKernels =
    MICROTRACE_KERNEL_TABLES(kPortableScene, kAvx2Scene, kAvx512Scene);

}  // namespace microtrace
