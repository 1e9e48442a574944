#pragma once
/// Items that users select by name or by index, such as the cameras of a scene.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace microtrace {

/// Returns the index of the first item with the name `wanted`, or else of the item whose index from
/// 0 `wanted` is, in decimal digits.
[[nodiscard]] std::optional<std::size_t> find_item(std::string_view wanted,
                                                   std::span<const std::string> names);

/// Returns the message that no item is selected: `there is no camera "left"; choose 0 (front), 1
/// (unnamed)`. `kind` is the noun for an item.
[[nodiscard]] std::string no_such_item(std::string_view kind, std::string_view wanted,
                                       std::span<const std::string> names);

}  // namespace microtrace
