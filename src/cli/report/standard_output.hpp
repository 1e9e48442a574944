#pragma once
/// Writes results to standard output.

#include <string>

namespace microtrace::cli {

/// Throws Error (io) if the text can't be written.
void write_standard_output(const std::string& text);

}  // namespace microtrace::cli
