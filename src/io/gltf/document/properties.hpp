#pragma once
/// Properties of objects that check_schema has accepted. Reading them can't fail.

#include "io/json/document.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace microtrace::io::gltf {

/// The nearest finite float32.
[[nodiscard]] float finite_float(double x);

[[nodiscard]] float number(const JsonValue& object, std::string_view key, float standard);

/// A vector with as many components as the schema requires.
template <typename Vector>
[[nodiscard]] Vector vector(const JsonValue& object, std::string_view key, const Vector& standard) {
  const JsonValue* value = object.find(key);
  if (value == nullptr) return standard;
  Vector result(0);
  for (int i = 0; i < Vector::length(); ++i) {
    result[i] = finite_float(value->items[static_cast<std::size_t>(i)].number);
  }
  return result;
}

/// 0 if absent; at most 2^32 - 1.
[[nodiscard]] std::uint32_t index(const JsonValue& object, std::string_view key);

/// Empty if absent.
[[nodiscard]] std::string name_of(const JsonValue& object);

}  // namespace microtrace::io::gltf
