#pragma once
/// Rules that many objects of glTF 2.0 and its extensions have.

#include "io/gltf/check/schema/schema.hpp"

#include <cstddef>
#include <limits>
#include <string_view>

namespace microtrace::io::gltf {

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

constexpr Rule factor(std::string_view key) {
  return {.key = key, .form = Form::number, .min = 0, .max = 1, .repair = Repair::clamp};
}
constexpr Rule at_least(std::string_view key, double min) {
  return {.key = key, .form = Form::number, .min = min, .repair = Repair::clamp};
}
/// A number above 0; without it, or with another, its object's default.
constexpr Rule positive(std::string_view key) {
  return {.key = key, .form = Form::number, .min = 0, .above_min = true, .repair = Repair::drop};
}
constexpr Rule number(std::string_view key) {
  return {.key = key, .form = Form::number};
}
constexpr Rule vector(std::string_view key, std::size_t length) {
  return {.key = key, .form = Form::numbers, .fewest = length, .most = length};
}
constexpr Rule color(std::string_view key, double max = 1, std::size_t channels = 3) {
  return {.key = key,
          .form = Form::numbers,
          .min = 0,
          .max = max,
          .fewest = channels,
          .most = channels,
          .repair = Repair::clamp};
}
/// One of the known numbers, or as if it were absent.
constexpr Rule choice(std::string_view key, std::span<const double> values) {
  return {.key = key, .form = Form::integer, .values = values, .repair = Repair::drop};
}
constexpr Rule choice(std::string_view key, std::span<const std::string_view> strings,
                      bool required = false, Repair repair = Repair::drop) {
  return {
      .key = key, .form = Form::string, .required = required, .strings = strings, .repair = repair};
}
/// A texture info with those members.
constexpr Rule texture(std::string_view key, std::span<const Rule> members = texture_info_rules) {
  return {.key = key, .form = Form::object, .members = members, .place = Place::texture_info};
}
constexpr Rule normal_texture(std::string_view key) {
  return texture(key, normal_texture_rules);
}
constexpr Rule index_of(std::string_view key, std::string_view target, bool required = false) {
  return {.key = key, .form = Form::index, .required = required, .target = target};
}

}  // namespace microtrace::io::gltf
