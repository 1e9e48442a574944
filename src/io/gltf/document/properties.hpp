#pragma once
/// Reads properties of objects that check_schema has accepted. Reading can't fail.

#include "io/json/document.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

/// Returns the finite float32 nearest to x.
[[nodiscard]] float finite_float(double x);

[[nodiscard]] float number(const JsonValue& object, std::string_view key, float standard);

/// Converts a number that is an index, a count or a length.
[[nodiscard]] inline std::size_t index_from(const JsonValue& value) {
  return static_cast<std::size_t>(value.number());
}
/// Returns the index in an optional member.
[[nodiscard]] std::optional<std::size_t> index_in(const JsonValue& object, std::string_view key);

/// Reads a vector, which has as many components as the schema requires.
template <typename Vector>
[[nodiscard]] Vector vector(const JsonValue& object, std::string_view key, const Vector& standard) {
  const JsonValue* value = object.find(key);
  if (value == nullptr) return standard;
  Vector result(0);
  for (int i = 0; i < Vector::length(); ++i) {
    result[i] = finite_float(value->items()[static_cast<std::size_t>(i)].number());
  }
  return result;
}

/// Reads an index of at most 2^32 - 1. Returns 0 if it is absent.
[[nodiscard]] std::uint32_t index(const JsonValue& object, std::string_view key);

/// Returns the object's name. Empty if absent.
[[nodiscard]] std::string name_of(const JsonValue& object);
/// Returns the names of objects. Empty where absent.
[[nodiscard]] std::vector<std::string> names_of(std::span<const JsonValue> objects);

}  // namespace microtrace::io::gltf
