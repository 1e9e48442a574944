#pragma once
#include <cstdint>
#include <functional>

namespace microtrace::cli {

/// Draws a progress bar with the remaining time on standard error after half a second, and clears
/// it at the end. With several pictures it shows the current one. Empty if standard error is not a
/// terminal that can draw it. The functions returned here and below are called with the finished
/// fraction of the work.
[[nodiscard]] std::function<void(double)> progress_bar(std::uint32_t pictures);

/// Writes lines {"progress": FRACTION, "seconds": SINCE_START} to standard error, at most ten per
/// second and one at the end.
[[nodiscard]] std::function<void(double)> progress_lines();

}  // namespace microtrace::cli
