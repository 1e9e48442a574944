#pragma once
/// The floating-point rules that exactness and equal bits stand on: round to nearest, subnormal
/// numbers as they are. A host program may have set others for its threads: flushing to zero is
/// common in audio and graphics, and GCC sets it at start-up for any program linked with
/// -ffast-math.

#include <cstdint>

namespace microtrace {

/// Sets these rules for the calling thread, and the former ones again at its end. Costs a few
/// cycles where they are set already.
class FloatEnvironment {
 public:
  FloatEnvironment() : former_(get()) {
    if ((former_ & kOtherRules) != 0) set(former_ & ~kOtherRules);
  }
  ~FloatEnvironment() {
    if ((former_ & kOtherRules) != 0) set(former_);
  }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
#if defined(__x86_64__)
  using Register = std::uint32_t;
  // MXCSR: denormals are zeros (bit 6), rounding control (13 and 14), flush to zero (15).
  static constexpr Register kOtherRules = (1U << 6U) | (3U << 13U) | (1U << 15U);
  static Register get() {
    return __builtin_ia32_stmxcsr();
  }
  static void set(Register value) {
    __builtin_ia32_ldmxcsr(value);
  }
#elif defined(__aarch64__)
  using Register = std::uint64_t;
  // FPCR: rounding mode (bits 22 and 23), flush to zero (24).
  static constexpr Register kOtherRules = 7U << 22U;
  static Register get() {
    Register value;
    __asm__ volatile("mrs %0, fpcr" : "=r"(value));
    return value;
  }
  static void set(Register value) {
    __asm__ volatile("msr fpcr, %0" : : "r"(value));
  }
#else
#error \
    "Say here how this processor's rounding mode and flushing of subnormal numbers are read and set."
#endif

  Register former_;
};

}  // namespace microtrace
