#include "accel/kernels/dispatch.hpp"

#include <cstdlib>
#include <string_view>

namespace microtrace {
namespace {

bool is_available(const Kernels& kernels) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (&kernels == &kAvx512Kernels)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
  if (&kernels == &kAvx2Kernels)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return &kernels == &kPortableKernels;
}

// The fastest first; the last runs everywhere.
constexpr const Kernels* kAll[] = {
#if defined(__x86_64__)
    &kAvx512Kernels,
    &kAvx2Kernels,
#endif
    &kPortableKernels,
};

}  // namespace

std::vector<const Kernels*> available_kernels() {
  std::vector<const Kernels*> available;
  for (const Kernels* kernels : kAll) {
    if (is_available(*kernels)) available.push_back(kernels);
  }
  return available;
}

const Kernels& best_kernels() {
  const char* wanted = std::getenv("MICROTRACE_ISA");
  for (const Kernels* kernels : kAll) {
    if (is_available(*kernels) && (wanted == nullptr || std::string_view(wanted) == kernels->name))
      return *kernels;
  }
  return kPortableKernels;
}

}  // namespace microtrace
