#pragma once
/// The kernels of all instruction sets. Not to be included by the kernels' own translation units.

#include "queries/kernels/kernel.hpp"
#include "simd/kernel_tables.hpp"

namespace microtrace {

inline constexpr KernelTables<QueryKernels> kQueryKernels =
    MICROTRACE_KERNEL_TABLES(kPortableQueries, kAvx2Queries, kAvx512Queries);

}  // namespace microtrace
