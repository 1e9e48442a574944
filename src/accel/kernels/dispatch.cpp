#include "accel/kernels/dispatch.hpp"

#include "simd/instruction_set.hpp"

namespace microtrace {
namespace {

const Kernels* kernels_of(InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512) return &kAvx512Kernels;
  if (set == InstructionSet::avx2) return &kAvx2Kernels;
#endif
  return &kPortableKernels;
}

const SpawnKernels& spawn_kernels_of(InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512) return kAvx512Spawn;
  if (set == InstructionSet::avx2) return kAvx2Spawn;
#endif
  return kPortableSpawn;
}

}  // namespace

std::vector<const Kernels*> available_kernels() {
  std::vector<const Kernels*> available;
  for (const InstructionSet set : available_instruction_sets())
    available.push_back(kernels_of(set));
  return available;
}

const Kernels& best_kernels() {
  return *kernels_of(best_instruction_set());
}

const SpawnKernels& best_spawn_kernels() {
  return spawn_kernels_of(best_instruction_set());
}

}  // namespace microtrace
