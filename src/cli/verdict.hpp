#pragma once
/// What --validate prints.

#include <microtrace/error.hpp>

#include <cstddef>
#include <string>

namespace microtrace::cli {

/// Of a scene that can be drawn: `scene: valid`, `scene: valid, 2 warnings` or `scene: invalid, but
/// drawable: 1 error, 2 warnings`, on standard output. Throws Error (io) where
/// it can't be written.
void print_findings(const std::string& scene, std::size_t errors, std::size_t warnings);

/// `scene: invalid`, or whatever else kept it from being drawn, on standard output.
void print_refused(const std::string& scene, ErrorKind kind);

}  // namespace microtrace::cli
