#pragma once
/// The kernels for all instruction sets. The kernels' own translation units must not include this
/// header.

#include "accel/instances/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<InstanceKernels> kInstanceKernels =
    MICROTRACE_KERNEL_TABLES(kPortableInstances, kAvx2Instances, kAvx512Instances);

}  // namespace microtrace
