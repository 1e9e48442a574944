#include "cli/report/unusual_counts.hpp"

#include "cli/report/progress_bar.hpp"

#include <cstdio>

namespace microtrace::cli {

bool warn_about(const RenderCounts& counts, unsigned threads) {
  const bool is_unusual = counts.invalid_samples > 0 || counts.missing_threads > 0;
  if (is_unusual) clear_progress_bar();
  if (counts.invalid_samples > 0) {
    std::fprintf(stderr, "warning: %llu samples were not numbers (NaN) and count as black\n",
                 static_cast<unsigned long long>(counts.invalid_samples));
  }
  if (counts.missing_threads > 0) {
    std::fprintf(
        stderr,
        "warning: the system refused to start %u of %u threads (limit on processes or memory); the "
        "picture is the same but took longer\n",
        counts.missing_threads, threads);
  }
  return is_unusual;
}

}  // namespace microtrace::cli
