#pragma once
#include "cli/arguments.hpp"

namespace microtrace::cli {

/// The exit code for pictures that differ.
inline constexpr int kPicturesDiffer = 7;

/// Compares two pictures and prints the result. Returns the exit code. Throws Error.
[[nodiscard]] int compare_files(const Arguments& arguments);

}  // namespace microtrace::cli
