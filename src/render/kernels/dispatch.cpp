#include "render/kernels/dispatch.hpp"

#include "simd/instruction_set.hpp"

namespace microtrace {
namespace {

const ShadingKernels* kernels_of(InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512) return &kAvx512Shading;
  if (set == InstructionSet::avx2) return &kAvx2Shading;
#endif
  return &kPortableShading;
}

}  // namespace

std::vector<const ShadingKernels*> available_shading_kernels() {
  std::vector<const ShadingKernels*> available;
  for (const InstructionSet set : available_instruction_sets())
    available.push_back(kernels_of(set));
  return available;
}

const ShadingKernels& best_shading_kernels() {
  return *kernels_of(best_instruction_set());
}

}  // namespace microtrace
