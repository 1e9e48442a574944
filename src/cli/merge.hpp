#pragma once
/// `microtrace merge` combines the samples of several checkpoints into one picture.

#include "cli/arguments.hpp"

namespace microtrace::cli {

/// Writes the picture of arguments.checkpoints. Takes absent display options from the first
/// checkpoint. Throws Error, of kind usage if samples are missing and missing samples are not
/// allowed.
void merge_samples(const Arguments& arguments);

}  // namespace microtrace::cli
