#pragma once
#include <cstdint>
#include <functional>

namespace microtrace::cli {

/// Returns a function that draws a progress bar with the remaining time on standard error. The bar
/// appears after half a second and is cleared at the end. With several pictures it shows the number
/// of the current picture. Nothing is drawn while the process is in the background. The function is
/// empty if standard error is not a terminal that can draw the bar. The caller must pass the
/// finished fraction of the work to the returned function, also for progress_lines().
[[nodiscard]] std::function<void(double)> progress_bar(std::uint32_t pictures);

/// Removes the bar if it is there. Must be called before other text is written to standard error.
/// May be called by signal handlers.
void clear_progress_bar();

/// Returns a function that writes lines {"progress": FRACTION, "seconds": SINCE_START} to standard
/// error: at most ten per second, and one at the end.
[[nodiscard]] std::function<void(double)> progress_lines();

}  // namespace microtrace::cli
