#pragma once
/// The objects that extensions add, and their members.

#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

namespace microtrace::io::gltf {

/// What the extension of that name adds to an object, if it adds anything.
[[nodiscard]] std::optional<Element> extension(const Element& object, std::string_view name);
/// The same without a place; null if there is none.
[[nodiscard]] const JsonValue* extension(const JsonValue& object, std::string_view name);

/// A number that must lie in [least, most], or `standard` where the object has none.
/// Throws Error (invalid_scene), as do all below.
[[nodiscard]] double number(const Asset& asset, const Element& object, std::string_view key,
                            double standard,
                            double least = -std::numeric_limits<double>::infinity(),
                            double most = std::numeric_limits<double>::infinity());

/// An integer from 0 to most that must be there.
[[nodiscard]] std::size_t whole_number(const Asset& asset, const Element& object,
                                       std::string_view key,
                                       std::size_t most = std::size_t{1} << 53U);

/// An index into an array of `size` items that must be there.
[[nodiscard]] std::size_t index(const Asset& asset, const Element& object, std::string_view key,
                                std::size_t size);

/// A string that must be there.
[[nodiscard]] const std::string& string(const Asset& asset, const Element& object,
                                        std::string_view key);

}  // namespace microtrace::io::gltf
