#pragma once
/// The result of --validate, on standard output.

#include <microtrace/error.hpp>

#include <cstddef>
#include <string>

namespace microtrace::cli {

/// Prints the result for a scene that can be rendered: `scene: valid`, `scene: valid, 2 warnings`
/// or `scene: invalid, but drawable: 1 error, 2 warnings`. Throws Error (io) if standard output
/// can't be written.
void print_validation_result(const std::string& scene, std::size_t errors, std::size_t warnings);

/// Prints the result for a scene that was rejected, such as `scene: invalid`.
void print_refusal(const std::string& scene, ErrorKind kind);

}  // namespace microtrace::cli
