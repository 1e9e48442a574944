// This preloaded library changes the floating-point environment before main. It sets the rounding
// mode to ROUNDING (an argument of fesetround), flushes subnormals, and reduces long double to
// float precision.

#include <cfenv>
#include <cstdint>
#include <cstdlib>

namespace {

[[gnu::constructor]] void set_rules() {
  const char* const rounding = std::getenv("ROUNDING");
  if (rounding == nullptr) return;
  std::fesetround(std::atoi(rounding));
#if defined(__x86_64__)
  __builtin_ia32_ldmxcsr(__builtin_ia32_stmxcsr() | (1U << 6U) | (1U << 15U));
  std::uint16_t control = 0;
  __asm__ volatile("fnstcw %0" : "=m"(control));
  control = static_cast<std::uint16_t>(control & ~0x300U);
  __asm__ volatile("fldcw %0" : : "m"(control));
#endif
}

}  // namespace
