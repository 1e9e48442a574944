#pragma once
#include "io/json/document.hpp"

#include <cstddef>
#include <string_view>

namespace microtrace::io {

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Parses the text of the document. Throws Error as the constructor of JsonDocument does.
void build_tree(const JsonDocument& document, std::string_view text, JsonValue& root,
                std::size_t max_values, RepeatedKeys policy, OutdoneKeys& outdone_keys);

}  // namespace microtrace::io
