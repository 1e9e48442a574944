#pragma once
/// Extension objects and their properties.

#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

namespace microtrace::io::gltf {

/// The object that an extension adds to `object`, if any.
[[nodiscard]] std::optional<Element> extension(const Element& object, std::string_view name);
/// The same without a pointer; null if absent.
[[nodiscard]] const JsonValue* extension(const JsonValue& object, std::string_view name);

/// A number in [least, most]; `standard` if the property is absent. Throws Error (invalid_scene),
/// as do all functions below.
[[nodiscard]] double number(const Asset& asset, const Element& object, std::string_view key,
                            double standard,
                            double least = -std::numeric_limits<double>::infinity(),
                            double most = std::numeric_limits<double>::infinity());

/// A required integer from 0 to most.
[[nodiscard]] std::size_t whole_number(const Asset& asset, const Element& object,
                                       std::string_view key,
                                       std::size_t most = std::size_t{1} << 53U);

/// A required index into an array of `size` items.
[[nodiscard]] std::size_t index(const Asset& asset, const Element& object, std::string_view key,
                                std::size_t size);

/// A required string.
[[nodiscard]] const std::string& string(const Asset& asset, const Element& object,
                                        std::string_view key);

}  // namespace microtrace::io::gltf
