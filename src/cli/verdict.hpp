#pragma once
/// What --validate prints.

#include <microtrace/error.hpp>

#include <cstddef>
#include <string>

namespace microtrace::cli {

/// `scene: valid` or `scene: valid, 2 warnings`, on standard output. Throws Error (io) where it
/// can't be written.
void print_valid(const std::string& scene, std::size_t warnings);

/// `scene: invalid`, or whatever else kept it from being drawn, on standard output.
void print_refused(const std::string& scene, ErrorKind kind);

}  // namespace microtrace::cli
