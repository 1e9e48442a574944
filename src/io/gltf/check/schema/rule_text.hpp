#pragma once
/// Describes rules in error messages.

#include "io/gltf/document/rules.hpp"

#include <string>

namespace microtrace::io::gltf {

/// Returns the number with enough digits to identify it.
[[nodiscard]] std::string text_of(double number);

/// Returns the range of valid numbers, for example " of at least 0 and at most 1". Empty without a
/// range.
[[nodiscard]] std::string range_of(const Rule& rule);

/// Returns the list of valid values, for example "OPAQUE", "MASK", "BLEND".
[[nodiscard]] std::string values_of(const Rule& rule);

}  // namespace microtrace::io::gltf
