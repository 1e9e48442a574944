#pragma once
/// Suggestions for unknown names.

#include <span>
#include <string>
#include <string_view>

namespace microtrace {

/// The known name with the least edit distance, if this is at most 2 or a third of the length of
/// `name`; else an empty string.
[[nodiscard]] std::string_view nearest_name(std::string_view name,
                                            std::span<const std::string_view> known);

/// Text to append to a message about `name`: `; did you mean "radius"?` if a known name is similar,
/// else `; known are "a", "b"`, or nothing if no names are known.
[[nodiscard]] std::string suggestion(std::string_view name,
                                     std::span<const std::string_view> known);

}  // namespace microtrace
