#pragma once
/// Which shading kernels run. Not for the kernels' own translation units.

#include "render/kernels/kernel.hpp"

#include <vector>

namespace microtrace {

/// The sets that this processor runs, the fastest first.
[[nodiscard]] std::vector<const ShadingKernels*> available_shading_kernels();

/// Those of best_instruction_set().
[[nodiscard]] const ShadingKernels& best_shading_kernels();

}  // namespace microtrace
