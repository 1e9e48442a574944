#pragma once
/// A fixture for tests of what a host program's rounding mode, precision, traps and flushing of
/// subnormals change.

#include <cfenv>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

namespace microtrace::tests {

inline bool is_flushing() {
  volatile float least = std::numeric_limits<float>::denorm_min();
  return least * 1.0F == 0;
}

#if defined(__x86_64__)
/// Returns the x87 control word, which sets rounding and precision of long double.
inline std::uint16_t x87_control() {
  std::uint16_t control = 0;
  __asm__ volatile("fnstcw %0" : "=m"(control));
  return control;
}

/// Sets the precision of long double to 24 or to 64 bits.
inline void set_x87_precision(bool is_short) {
  const auto control =
      static_cast<std::uint16_t>((x87_control() & ~0x300U) | (is_short ? 0U : 0x300U));
  __asm__ volatile("fldcw %0" : : "m"(control));
}
#endif

inline void flush_subnormals(bool flush) {
#if defined(__x86_64__)
  const std::uint32_t bits = (1U << 6U) | (1U << 15U);
  const std::uint32_t now = __builtin_ia32_stmxcsr();
  __builtin_ia32_ldmxcsr(flush ? now | bits : now & ~bits);
  set_x87_precision(flush);
#else
  std::uint64_t now;
  __asm__ volatile("mrs %0, fpcr" : "=r"(now));
  now = flush ? now | (1U << 24U) : now & ~(std::uint64_t{1} << 24U);
  __asm__ volatile("msr fpcr, %0" : : "r"(now));
#endif
}

class HostRules : public testing::TestWithParam<int> {
 protected:
  void set() {
    std::fesetround(GetParam());
    flush_subnormals(true);
  }
  void expect_kept() {
    EXPECT_EQ(std::fegetround(), GetParam());
    EXPECT_TRUE(is_flushing());
#if defined(__x86_64__)
    EXPECT_EQ(x87_control() & 0x300U, 0U);
#endif
  }
  void TearDown() override {
    std::fesetround(FE_TONEAREST);
    flush_subnormals(false);
  }
};

}  // namespace microtrace::tests
