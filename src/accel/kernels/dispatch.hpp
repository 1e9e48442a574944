#pragma once
/// Selects the kernels to run. Not to be included by the kernels' own translation units.

#include "accel/kernels/kernel.hpp"
#include "accel/spawn/kernels/kernel.hpp"

#include <vector>

namespace microtrace {

/// Kernels for the instruction sets that this processor supports, fastest first.
[[nodiscard]] std::vector<const Kernels*> available_kernels();

/// The first of them, or the ones that the environment variable MICROTRACE_ISA names (portable,
/// avx2, avx512); portable if these are not available.
[[nodiscard]] const Kernels& best_kernels();

/// The kernels for rays that leave surfaces, selected the same way.
[[nodiscard]] const SpawnKernels& best_spawn_kernels();

}  // namespace microtrace
