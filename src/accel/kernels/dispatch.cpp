#include "accel/kernels/kernel.hpp"

#include <cstdlib>
#include <cstring>

namespace microtrace {
namespace {

const Kernels& choose() {
#if defined(__x86_64__)
  const char* wanted = std::getenv("MICROTRACE_ISA");
  const auto allowed = [&](const Kernels& kernels) {
    return wanted == nullptr || std::strcmp(wanted, kernels.name) == 0;
  };
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
  if (avx512 && allowed(kAvx512Kernels)) return kAvx512Kernels;
  if (avx2 && allowed(kAvx2Kernels)) return kAvx2Kernels;
#endif
  return kPortableKernels;
}

}  // namespace

const Kernels& best_kernels() {
  static const Kernels& kernels = choose();
  return kernels;
}

}  // namespace microtrace
