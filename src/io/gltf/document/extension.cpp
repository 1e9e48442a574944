#include "io/gltf/document/extension.hpp"

#include "base/text/printable.hpp"

#include <cmath>
#include <string>

namespace microtrace::io::gltf {
namespace {

Element required(const Asset& asset, const Element& object, std::string_view key) {
  if (object.value->find(key) == nullptr) {
    asset.fail(object, "lacks the required property " + in_quotes(std::string(key)));
  }
  return object.member(key);
}

}  // namespace

std::optional<Element> extension(const Element& object, std::string_view name) {
  if (extension(*object.value, name) == nullptr) return std::nullopt;
  return object.member("extensions").member(name);
}

const JsonValue* extension(const JsonValue& object, std::string_view name) {
  const JsonValue* extensions = object.find("extensions");
  return extensions != nullptr ? extensions->find(name) : nullptr;
}

double number(const Asset& asset, const Element& object, std::string_view key, double standard,
              double least, double most) {
  const JsonValue* value = object.value->find(key);
  if (value == nullptr) return standard;
  const bool in_range = value->number() >= least && value->number() <= most;
  if (value->kind() == JsonValue::Kind::number && in_range) return value->number();
  asset.fail(object.member(key), "must be a number in its range");
}

std::size_t whole_number(const Asset& asset, const Element& object, std::string_view key,
                         std::size_t most) {
  const Element at = required(asset, object, key);
  const double value = at.value->number();
  if (at.value->kind() == JsonValue::Kind::number && value >= 0 && std::trunc(value) == value &&
      value <= static_cast<double>(most)) {
    return static_cast<std::size_t>(value);
  }
  asset.fail(at, "must be an integer from 0 to " + std::to_string(most));
}

std::size_t index(const Asset& asset, const Element& object, std::string_view key,
                  std::size_t size) {
  if (size > 0) return whole_number(asset, object, key, size - 1);
  asset.fail(required(asset, object, key), "is an index into an array that is empty or absent");
}

const std::string& string(const Asset& asset, const Element& object, std::string_view key) {
  const Element at = required(asset, object, key);
  if (at.value->kind() != JsonValue::Kind::string) asset.fail(at, "must be a string");
  return at.value->string();
}

}  // namespace microtrace::io::gltf
