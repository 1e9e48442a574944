#pragma once
/// Descriptions of rules for error messages.

#include "io/gltf/document/rules.hpp"

#include <string>

namespace microtrace::io::gltf {

/// The number with all digits needed to identify it.
[[nodiscard]] std::string text_of(double number);

/// For example " of at least 0 and at most 1"; empty without a range.
[[nodiscard]] std::string range_of(const Rule& rule);

/// For example "OPAQUE", "MASK", "BLEND".
[[nodiscard]] std::string values_of(const Rule& rule);

}  // namespace microtrace::io::gltf
