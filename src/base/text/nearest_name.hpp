#pragma once
/// Suggestions for unknown names.

#include <span>
#include <string>
#include <string_view>

namespace microtrace {

/// Returns the known name with the least edit distance from `name`, or an empty string if that
/// distance exceeds both 2 and a third of the length of `name`.
[[nodiscard]] std::string_view nearest_name(std::string_view name,
                                            std::span<const std::string_view> known);

/// Returns text to append to a message about an unknown name: `; did you mean "radius"?` if a known
/// name is similar, otherwise `; known are "a", "b"`, or an empty string if no names are known.
[[nodiscard]] std::string suggestion(std::string_view name,
                                     std::span<const std::string_view> known);

}  // namespace microtrace
