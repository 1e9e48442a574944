#pragma once
/// The kernels for all instruction sets. The kernels' own translation units must not include this
/// header.

#include "queries/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<QueryKernels> kQueryKernels =
    MICROTRACE_KERNEL_TABLES(kPortableQueries, kAvx2Queries, kAvx512Queries);

}  // namespace microtrace
