#pragma once
/// What messages say of the values that a rule allows.

#include "io/gltf/document/rules.hpp"

#include <string>

namespace microtrace::io::gltf {

/// With all the digits that tell it from others.
[[nodiscard]] std::string text_of(double number);

/// As " of at least 0 and at most 1"; empty for a rule without a range.
[[nodiscard]] std::string range_of(const Rule& rule);

/// As "OPAQUE", "MASK", "BLEND".
[[nodiscard]] std::string values_of(const Rule& rule);

}  // namespace microtrace::io::gltf
