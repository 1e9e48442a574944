#pragma once
#include "io/json/document.hpp"

#include <span>
#include <string>
#include <string_view>

namespace microtrace::io {

/// Appends a value as compact JSON that parses to the same value. Omits members with these names at
/// any depth. Integers within +-2^53 have no fraction and no exponent; -0 becomes 0, because
/// readers of integers might not accept it.
void append_json(std::string& text, const JsonValue& value,
                 std::span<const std::string_view> left_out);

/// Appends a finite number, with the fewest digits that identify it.
void append_json(std::string& text, double x);

/// Appends a string with quotes and escapes.
void append_json(std::string& text, std::string_view string);

}  // namespace microtrace::io
