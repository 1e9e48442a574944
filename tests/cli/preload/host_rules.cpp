// Preloaded library: before main, sets the rounding mode ROUNDING (an argument of fesetround), the
// flushing of subnormals, and float precision for long double.

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
