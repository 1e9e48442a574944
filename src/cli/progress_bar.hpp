#pragma once
#include <cstdint>
#include <functional>

namespace microtrace::cli {

/// Draws a progress bar with the time left on standard error, from the first half second on; clears
/// it at the end. Of several pictures, it says which is drawn. Empty where standard error is no
/// terminal, or a dumb one.
[[nodiscard]] std::function<void(double)> progress_bar(std::uint32_t pictures = 1);

/// Writes {"progress": SHARE, "seconds": SINCE_START} to standard error, a line at a time: ten a
/// second at most, and one at the end.
[[nodiscard]] std::function<void(double)> progress_lines();

}  // namespace microtrace::cli
