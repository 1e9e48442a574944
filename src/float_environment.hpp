#pragma once
/// The floating-point rules behind exactness and equal bits: round to nearest, keep subnormal
/// numbers, raise no signals. A host program may have set other rules for its threads: flushing to
/// zero is common in audio and graphics, and GCC sets it at start-up for any program linked with
/// -ffast-math.

#include <cstdint>

namespace microtrace {

#if defined(__x86_64__)

/// The control words of the processor.
class FloatControl {
 public:
  static FloatControl get() {
    FloatControl now;
    now.mxcsr_ = __builtin_ia32_stmxcsr();
    __asm__ volatile("fnstcw %0" : "=m"(now.x87_));
    return now;
  }
  void set() const {
    // An exception flagged under the rules before must not be raised under these.
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
  // Flags of exceptions (bits 0 to 5), denormals are zeros (6), masks of exceptions (7 to 12),
  // rounding control (13 and 14), flush to zero (15).
  static constexpr std::uint32_t kFlags = 0x3F, kMasks = 0x3F << 7U,
                                 kOther = (1U << 6U) | (3U << 13U) | (1U << 15U);
  // Masks of exceptions (bits 0 to 5), precision control (8 and 9: all 64 bits of a long double),
  // rounding control (10 and 11).
  static constexpr std::uint16_t kX87Masks = 0x3F, kX87Rules = 0xF00, kX87Right = 0x33F;

  std::uint32_t mxcsr_ = 0;
  std::uint16_t x87_ = 0;
};

#elif defined(__aarch64__)

/// The control word of the processor.
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
  // Flushing of inputs to zero (bit 0), traps of exceptions (8 to 12 and 15), flushing of halves
  // (19), rounding mode (22 and 23), flushing to zero (24).
  static constexpr std::uint64_t kOther =
      1U | (0x1FU << 8U) | (1U << 15U) | (1U << 19U) | (7U << 22U);

  std::uint64_t fpcr_ = 0;
};

#else
#error "Write here how this processor's rounding mode and flushing of subnormals are read and set."
#endif

/// Sets these rules for the calling thread, and the former ones again at its end. Costs a few
/// cycles where they are set already. Every public function that computes has one; threads that the
/// library starts too.
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
