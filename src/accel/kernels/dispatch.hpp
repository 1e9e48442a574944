#pragma once
/// Which kernels run. Not for the kernels' own translation units.

#include "accel/kernels/kernel.hpp"
#include "accel/spawn/kernels/kernel.hpp"

#include <vector>

namespace microtrace {

/// The sets that this processor runs, the fastest first.
[[nodiscard]] std::vector<const Kernels*> available_kernels();

/// The first of them; or the one that the environment variable MICROTRACE_ISA names (portable,
/// avx2, avx512), if it is among them, portable if it is not.
[[nodiscard]] const Kernels& best_kernels();

/// For rays that leave surfaces, chosen likewise.
[[nodiscard]] const SpawnKernels& best_spawn_kernels();

}  // namespace microtrace
