#pragma once
/// Sets the floating-point environment that exactness and equal bits require: rounding to nearest,
/// no flushing of subnormal numbers, no traps. The host program may use other settings. Flushing to
/// zero is common in audio and graphics, and GCC enables it at startup in programs linked with
/// -ffast-math. The library itself can't be compiled with that option.

#include <cstdint>

#if defined(__FAST_MATH__) || __FINITE_MATH_ONLY__
#error "microtrace needs -fno-fast-math and -fno-finite-math-only after other options."
#endif

namespace microtrace {

#if defined(__x86_64__)

/// The floating-point control registers of the processor.
class FloatControl {
 public:
  static FloatControl get() {
    FloatControl now;
    now.mxcsr_ = __builtin_ia32_stmxcsr();
    __asm__ volatile("fnstcw %0" : "=m"(now.x87_));
    return now;
  }
  void set() const {
    // Clears pending exceptions, because those that the previous settings masked would otherwise be
    // raised under the new settings.
    if ((x87_ & kX87Masks) != kX87Masks) __asm__ volatile("fnclex");
    __asm__ volatile("fldcw %0" : : "m"(x87_));
    __builtin_ia32_ldmxcsr(mxcsr_);
  }

  [[nodiscard]] bool is_right() const {
    return (mxcsr_ & (kOther | kMasks)) == kMasks && (x87_ & (kX87Rules | kX87Masks)) == kX87Right;
  }
  [[nodiscard]] FloatControl righted() const {
    FloatControl right = *this;
    right.mxcsr_ = (mxcsr_ & ~(kOther | kFlags)) | kMasks;
    right.x87_ = static_cast<std::uint16_t>((x87_ & ~kX87Rules) | kX87Right);
    return right;
  }

 private:
  // MXCSR: exception flags (bits 0 to 5), denormals are zeros (6), exception masks (7 to 12),
  // rounding control (13 and 14), flush to zero (15).
  static constexpr std::uint32_t kFlags = 0x3F, kMasks = 0x3F << 7U,
                                 kOther = (1U << 6U) | (3U << 13U) | (1U << 15U);
  // x87 control word: exception masks (bits 0 to 5), precision control (8 and 9: all 64 bits of a
  // long double), rounding control (10 and 11).
  static constexpr std::uint16_t kX87Masks = 0x3F, kX87Rules = 0xF00, kX87Right = 0x33F;

  std::uint32_t mxcsr_ = 0;
  std::uint16_t x87_ = 0;
};

#elif defined(__aarch64__)

/// The floating-point control register of the processor.
class FloatControl {
 public:
  static FloatControl get() {
    FloatControl now;
    __asm__ volatile("mrs %0, fpcr" : "=r"(now.fpcr_));
    return now;
  }
  void set() const { __asm__ volatile("msr fpcr, %0" : : "r"(fpcr_)); }

  [[nodiscard]] bool is_right() const { return (fpcr_ & kOther) == 0; }
  [[nodiscard]] FloatControl righted() const {
    FloatControl right = *this;
    right.fpcr_ &= ~kOther;
    return right;
  }

 private:
  // FPCR: flush inputs to zero (bit 0), exception traps (8 to 12 and 15), flush half precision
  // (19), rounding mode (22 and 23), flush to zero (24).
  static constexpr std::uint64_t kOther =
      1U | (0x1FU << 8U) | (1U << 15U) | (1U << 19U) | (7U << 22U);

  std::uint64_t fpcr_ = 0;
};

#elif defined(__riscv)

/// The rounding mode of the processor, which neither flushes subnormals nor traps.
class FloatControl {
 public:
  static FloatControl get() {
    FloatControl now;
    __asm__ volatile("frrm %0" : "=r"(now.mode_));
    return now;
  }
  void set() const { __asm__ volatile("fsrm %0" : : "r"(mode_)); }

  [[nodiscard]] bool is_right() const { return mode_ == kNearest; }
  [[nodiscard]] static FloatControl righted() { return {}; }

 private:
  static constexpr unsigned long kNearest = 0;
  unsigned long mode_ = kNearest;
};

#else
#error "Write here how this processor's rounding mode and flushing of subnormals are read and set."
#endif

/// Applies these settings to the calling thread, and restores the previous settings when destroyed.
/// Takes only a few cycles if the settings already apply. Every public function that computes
/// creates such an object, and so does every thread of the library.
class FloatEnvironment {
 public:
  FloatEnvironment() : former_(FloatControl::get()) {
    if (!former_.is_right()) former_.righted().set();
  }
  ~FloatEnvironment() {
    if (!former_.is_right()) former_.set();
  }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
  FloatControl former_;
};

}  // namespace microtrace
