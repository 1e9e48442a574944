#include "io/gltf/document/properties.hpp"

#include <algorithm>
#include <limits>

namespace microtrace::io::gltf {

float finite_float(double x) {
  constexpr double kGreatest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(x, -kGreatest, kGreatest));
}

float number(const JsonValue& object, std::string_view key, float standard) {
  const JsonValue* value = object.find(key);
  return value != nullptr ? finite_float(value->number()) : standard;
}

std::optional<std::size_t> index_in(const JsonValue& object, std::string_view key) {
  const JsonValue* value = object.find(key);
  return value != nullptr ? std::optional(index_from(*value)) : std::nullopt;
}

std::uint32_t index(const JsonValue& object, std::string_view key) {
  const JsonValue* value = object.find(key);
  constexpr std::uint32_t kGreatest = std::numeric_limits<std::uint32_t>::max();
  if (value == nullptr) return 0;
  return static_cast<std::uint32_t>(std::min<double>(value->number(), kGreatest));
}

std::string name_of(const JsonValue& object) {
  const JsonValue* name = object.find("name");
  return name != nullptr ? name->string() : std::string();
}

std::vector<std::string> names_of(std::span<const JsonValue> objects) {
  std::vector<std::string> names(objects.size());
  std::ranges::transform(objects, names.begin(), name_of);
  return names;
}

}  // namespace microtrace::io::gltf
