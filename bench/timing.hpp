#pragma once
/// How long work takes, and how it is shared out.

#include <cstddef>
#include <functional>
#include <vector>

namespace microtrace::bench {

/// Seconds that f() takes. With one thread the processor time of this process, which other
/// programs on the machine disturb least; with more the time that passes.
[[nodiscard]] double seconds(unsigned threads, const std::function<void()>& f);

/// f(begin, end) for consecutive parts of [0, size), one on each thread. Parts begin at multiples
/// of 64. Throws if denormal numbers are flushed to zero on a thread before or after: Embree's
/// manual asks for that, and one of the two programs must not run under other rules than the other.
void split(unsigned threads, std::size_t size,
           const std::function<void(std::size_t, std::size_t)>& f);

/// Of a copy; the mean of the middle two where their number is even.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace microtrace::bench
