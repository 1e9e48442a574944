#pragma once
/// Selects the shading kernels. Not to be included by the kernels' own translation units.

#include "render/kernels/kernel.hpp"

#include <vector>

namespace microtrace {

/// Kernels for the instruction sets that this processor supports, fastest first.
[[nodiscard]] std::vector<const ShadingKernels*> available_shading_kernels();

/// The kernels of best_instruction_set().
[[nodiscard]] const ShadingKernels& best_shading_kernels();

}  // namespace microtrace
