#include "io/scene_json/color.hpp"

#include "base/text/printable.hpp"

#include <string_view>
#include <vector>

namespace microtrace::io {
namespace {

void require_range(const JsonReader& json, double least, double most) {
  const double x = json.number();
  if (x >= least && x <= most) return;
  std::string message = "must lie between ";
  message.append(decimal(least)).append(" and ").append(decimal(most)).append(", is ");
  json.fail(message.append(decimal(x)));
}

Vec3 read_triple(const JsonReader& json, double most) {
  for (const JsonReader& channel : json.items(3)) require_range(channel, 0, most);
  return json.vector32();
}

}  // namespace

Colors read_colors(const JsonReader& json) {
  Colors colors;
  for (const auto& [name, color] : json.members()) colors.emplace(name, read_triple(color, 1));
  return colors;
}

Vec3 read_color(const JsonReader& json, const Colors& colors, double most) {
  if (json.value().kind() == JsonValue::Kind::array) return read_triple(json, most);
  if (json.value().kind() != JsonValue::Kind::string) {
    json.fail("must be three numbers from 0 to " + decimal(most) + " or a name from /colors");
  }
  const auto found = colors.find(json.string());
  if (found != colors.end()) return found->second;
  if (json.string().starts_with('#'))
    json.fail("must be three numbers such as [1, 0, 0] or a name from /colors, is " +
              in_quotes(json.string()));
  std::vector<std::string_view> names;
  for (const auto& [name, color] : colors) names.push_back(name);
  if (names.empty()) json.fail("is a name, but the scene names no colors in /colors");
  json.fail_unknown("color name", json.string(), names);
}

float read_at_least(const JsonReader& json, double least) {
  const double x = json.number();
  if (x >= least) return static_cast<float>(x);
  json.fail("must be at least " + decimal(least) + ", is " + decimal(x));
}

float read_in_range(const JsonReader& json, double least, double most) {
  require_range(json, least, most);
  return json.float32();
}

float read_share(const JsonReader& json) {
  return read_in_range(json, 0, 1);
}

float read_positive(const JsonReader& json) {
  const float x = json.float32();
  if (x > 0) return x;
  json.fail("must be positive, is " + decimal(json.number()));
}

bool read_boolean(const JsonReader& json) {
  if (json.value().kind() == JsonValue::Kind::boolean) return json.value().boolean();
  json.fail("must be true or false");
}

}  // namespace microtrace::io
