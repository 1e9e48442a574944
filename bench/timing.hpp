#pragma once
/// Measures time, and divides work between threads.

#include <cstddef>
#include <functional>
#include <vector>

namespace microtrace::bench {

/// Returns the seconds that f() takes. With one thread, this is the processor time of this process,
/// which other programs affect least. With more threads, it is the elapsed time.
[[nodiscard]] double seconds(unsigned threads, const std::function<void()>& f);

/// Calls f(begin, end) for consecutive parts of [0, size), one per thread. Parts begin at multiples
/// of 64. Throws if a thread flushes denormal numbers to zero before or after the call. Embree's
/// manual recommends this mode, but both programs must run in the same mode.
void split(unsigned threads, std::size_t size,
           const std::function<void(std::size_t, std::size_t)>& f);

/// Returns the median of the values; for an even number of values, the mean of the two in the
/// middle.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace microtrace::bench
