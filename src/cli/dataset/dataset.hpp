#pragma once
/// The commands `microtrace dataset` and `microtrace verify`.

#include "cli/arguments.hpp"

namespace microtrace::cli {

/// Renders the views of a data set that are missing. Throws Error.
void write_dataset(const Arguments& arguments);

/// Checks the files of a data set and renders some views again. Throws Error (io) for the first
/// file that is damaged or differs.
void verify_dataset(const Arguments& arguments);

}  // namespace microtrace::cli
