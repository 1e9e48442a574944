#pragma once
#include <microtrace/render.hpp>

namespace microtrace::cli {

/// Warns about samples that were not numbers, and about threads that the system refused to start;
/// `threads` were wanted. Returns true if there were any.
bool warn_about(const RenderCounts& counts, unsigned threads);

}  // namespace microtrace::cli
