#pragma once
/// Reads extension objects and their properties.

#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

namespace microtrace::io::gltf {

/// Returns the object of this extension in `object`, if any.
[[nodiscard]] std::optional<Element> extension(const Element& object, std::string_view name);
/// The same object without its pointer, or null.
[[nodiscard]] const JsonValue* extension(const JsonValue& object, std::string_view name);

/// Reads a number in [least, most]. Returns `standard` if the property is absent. Throws Error
/// (invalid_scene), like all functions below.
[[nodiscard]] double number(const Asset& asset, const Element& object, std::string_view key,
                            double standard,
                            double least = -std::numeric_limits<double>::infinity(),
                            double most = std::numeric_limits<double>::infinity());

/// Reads a required integer from 0 to `most`.
[[nodiscard]] std::size_t whole_number(const Asset& asset, const Element& object,
                                       std::string_view key,
                                       std::size_t most = std::size_t{1} << 53U);

/// Reads a required index into an array of `size` items.
[[nodiscard]] std::size_t index(const Asset& asset, const Element& object, std::string_view key,
                                std::size_t size);

/// Reads a required string.
[[nodiscard]] const std::string& string(const Asset& asset, const Element& object,
                                        std::string_view key);

}  // namespace microtrace::io::gltf
