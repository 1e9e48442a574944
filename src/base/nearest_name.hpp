#pragma once
/// Help for a name that is not known.

#include <span>
#include <string>
#include <string_view>

namespace microtrace {

/// The known name that is nearest by edit distance, if it differs by two letters or less or by a
/// third of a long name; else an empty one.
[[nodiscard]] std::string_view nearest_name(std::string_view name,
                                            std::span<const std::string_view> known);

/// What to add to a message about `name`: `; did you mean "radius"?` if a known name is near by
/// edit distance, else `; known are "a", "b"`, or nothing where none is known.
[[nodiscard]] std::string suggestion(std::string_view name,
                                     std::span<const std::string_view> known);

}  // namespace microtrace
