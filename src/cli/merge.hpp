#pragma once
/// microtrace merge: one picture of the samples of several checkpoints.

#include "cli/arguments.hpp"

namespace microtrace::cli {

/// Writes the picture of arguments.checkpoints. Display options that are absent are the first
/// checkpoint's. Throws Error: usage for missing samples, unless these are allowed.
void merge_samples(const Arguments& arguments);

}  // namespace microtrace::cli
