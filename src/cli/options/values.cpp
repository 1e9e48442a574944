#include "cli/options/values.hpp"

#include "base/text/split_at_commas.hpp"
#include "scene/math/srgb.hpp"
#include "scene/validate/validate.hpp"

#include <microtrace/environment.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace microtrace::cli {
namespace {

constexpr std::array kViews{
    Choice<View>{"front", {.azimuth = 0, .elevation = 0}},
    Choice<View>{"right", {.azimuth = 90, .elevation = 0}},
    Choice<View>{"back", {.azimuth = 180, .elevation = 0}},
    Choice<View>{"left", {.azimuth = 270, .elevation = 0}},
    Choice<View>{"top", {.azimuth = 0, .elevation = 90}},
    Choice<View>{"bottom", {.azimuth = 0, .elevation = -90}},
    // Looks along a cube's diagonal, so sin^2(elevation) = 1/3.
    Choice<View>{"iso", {.azimuth = 45, .elevation = 35.264389682754654}},
};

std::optional<Vec3> parse_hex_color(std::string_view digits) {
  if (digits.find_first_not_of("0123456789abcdefABCDEF") != std::string_view::npos)
    return std::nullopt;
  Vec3 color(0);
  const char* begin = digits.data();
  for (glm::length_t i = 0; i < 3; ++i, begin += 2) {
    std::uint8_t code = 0;
    std::from_chars(begin, begin + 2, code, 16);
    color[i] = static_cast<float>(linear_from_srgb(code / 255.0));
  }
  return color;
}

/// Parses directly to float32, because parsing to float64 first would round the number twice.
std::optional<float> parse_float(std::string_view text) {
  float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Parses #rrggbb in sRGB, or three linear values in [0, greatest].
std::optional<Vec3> parse_color(std::string_view text, float greatest) {
  if (text.size() == 7 && text[0] == '#') return parse_hex_color(text.substr(1));
  const std::vector<std::string_view> parts = split_at_commas(text);
  if (parts.size() != 3) return std::nullopt;
  Vec3 color(0);
  for (glm::length_t i = 0; i < 3; ++i) {
    const auto value = parse_float(parts[static_cast<std::size_t>(i)]);
    if (!value || !(*value >= 0 && *value <= greatest)) return std::nullopt;
    color[i] = *value;
  }
  return color;
}

template <class Quantities>
void add_names(std::vector<std::string>& names, const Quantities& quantities) {
  for (const auto quantity : quantities) names.emplace_back(name_of(quantity));
}

}  // namespace

ImageSize parse_size(const OptionValue& value) {
  const std::string_view text = value.text;
  const std::size_t x = text.find('x');
  const auto width = whole_number(text.substr(0, x));
  const auto height = x == text.npos ? std::nullopt : whole_number(text.substr(x + 1));
  if (!width || !height) value.refuse("WIDTHxHEIGHT in pixels, such as 640x480");
  const ImageSize size{.width = *width, .height = *height};
  if (const auto problem = validate(size))
    refuse_usage(value.option + ": " + problem->field + (problem->field.empty() ? "" : " ") +
                 problem->message);
  return size;
}

std::string parse_host(const OptionValue& value) {
  const std::string_view text = value.text;
  const bool is_address = text.starts_with('[');
  const std::size_t end = is_address ? text.find(']') : std::min(text.find(':'), text.size());
  if (end != text.npos) {
    const std::size_t bracket = is_address ? 1 : 0;
    const std::string_view name = text.substr(bracket, end - bracket);
    const std::string_view port = text.substr(end + bracket);
    const auto belongs = [is_address](char c) {
      const bool is_digit = c >= '0' && c <= '9';
      const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
      return is_digit || is_letter || c == '.' || c == (is_address ? ':' : '-');
    };
    const std::uint32_t number =
        port.starts_with(':') ? whole_number(port.substr(1)).value_or(0) : 0;
    const bool has_right_port = port.empty() || (number >= 1 && number <= 65535);
    if (!name.empty() && std::ranges::all_of(name, belongs) && has_right_port) return value.text;
  }
  value.refuse("a host name, such as hub.example.org or hub.example.org:8443");
}

PixelRect parse_crop(const OptionValue& value) {
  std::vector<std::uint32_t> sides;
  for (const std::string_view part : split_at_commas(value.text)) {
    if (const auto side = whole_number(part)) sides.push_back(*side);
  }
  if (sides.size() != 4 || split_at_commas(value.text).size() != 4)
    value.refuse("x0,y0,x1,y1 in pixels");
  return {.x0 = sides[0], .y0 = sides[1], .x1 = sides[2], .y1 = sides[3]};
}

DVec2 parse_pixel(const OptionValue& value) {
  const std::vector<double> numbers = numbers_of(value.text);
  if (numbers.size() != 2) value.refuse("two numbers x,y");
  return DVec2(numbers[0], numbers[1]) + 0.5;
}

WorldRay parse_ray(const OptionValue& value) {
  std::vector<double> origin;
  std::vector<float> numbers;  // of the origin too
  for (const std::string_view part : split_at_commas(value.text)) {
    const auto number = parse_float(part);
    const bool may_be_infinite = numbers.size() == 7;  // t_max
    if (!number || std::isnan(*number) || (std::isinf(*number) && !may_be_infinite))
      value.refuse("numbers of float32, of which only t_max may be inf");
    numbers.push_back(*number);
    if (origin.size() < 3) origin.push_back(numbers_of(part).front());
  }
  if (numbers.size() != 6 && numbers.size() != 8)
    value.refuse("six numbers ox,oy,oz,dx,dy,dz, or eight with t_min,t_max");
  WorldRay ray{.o = {origin[0], origin[1], origin[2]}, .d = {numbers[3], numbers[4], numbers[5]}};
  if (ray.d == Vec3(0)) refuse_usage(value.option + ": the direction must not be 0");
  if (numbers.size() == 8) ray.t_min = numbers[6], ray.t_max = numbers[7];
  if (!(0 <= ray.t_min && ray.t_min <= ray.t_max))
    refuse_usage(value.option + ": must have 0 <= t_min <= t_max");
  return ray;
}

OrbitView parse_view(const OptionValue& value) {
  for (const auto& [name, view] : kViews) {
    if (name == value.text) return {.view = view};
  }
  const std::vector<double> numbers = numbers_of(value.text);
  const bool has_distance = numbers.size() == 3;
  if ((numbers.size() != 2 && !has_distance) || std::abs(numbers[1]) > 90 ||
      (has_distance && !(numbers[2] > 0))) {
    std::string names;
    for (const auto& [name, view] : kViews) names.append(name).append(", ");
    value.refuse(names +
                 "or AZIMUTH,ELEVATION in degrees, elevation from -90 to 90, or both and a "
                 "distance above 0");
  }
  OrbitView orbit{.view = {.azimuth = numbers[0], .elevation = numbers[1]}};
  if (has_distance) orbit.distance = numbers[2];
  return orbit;
}

std::vector<std::string> view_names() {
  return names_of(kViews);
}

Background parse_background(const OptionValue& value) {
  if (value.text == "transparent") return {.kind = Background::Kind::transparent};
  if (value.text == "env") return {.kind = Background::Kind::environment};
  if (const auto color = parse_color(value.text, 1)) return {.color = *color};
  value.refuse(
      "transparent, env, #rrggbb (sRGB), or three numbers from 0 to 1 (linear light) such as "
      "0.2,0.4,1");
}

std::optional<Vec3> parse_radiance(const std::string& text) {
  return parse_color(text, kMaxRadiance);
}

EnvironmentSource parse_environment(const OptionValue& value) {
  if (value.text == "studio") return Studio{};
  if (const auto radiance = parse_radiance(value.text)) return *radiance;
  // Numbers that are no color are more likely a mistake than a file.
  const bool is_path =
      !value.text.empty() && value.text[0] != '#' && numbers_of(value.text).empty();
  if (is_path) return std::filesystem::path(value.text);
  value.refuse(
      "studio, #rrggbb (sRGB), three numbers from 0 up (linear light) such as 0.2,0.4,1, or a "
      "file");
}

Shard parse_shard(const OptionValue& value) {
  const std::string_view text = value.text;
  const std::size_t slash = text.find('/');
  const auto index = whole_number(text.substr(0, slash));
  const auto count = slash == text.npos ? std::nullopt : whole_number(text.substr(slash + 1));
  if (!index || !count || *index < 1 || *index > *count)
    value.refuse("I/N, shard I of N, with I from 1 to N");
  return {.index = *index, .count = *count};
}

NetworkAddress parse_address(const OptionValue& value) {
  const std::string& text = value.text;
  const std::size_t colon = text.rfind(':');
  const std::uint32_t port =
      colon == text.npos ? 0 : whole_number(text.substr(colon + 1)).value_or(0);
  std::string host = text.substr(0, colon);
  const bool has_brackets = host.starts_with('[') && host.ends_with(']');
  if (has_brackets) host = host.substr(1, host.size() - 2);
  const bool is_ambiguous = !has_brackets && host.find(':') != host.npos;
  if (host.empty() || is_ambiguous || port == 0 || port > 65535)
    value.refuse("HOST:PORT, such as localhost:14158");
  return {.host = std::move(host), .port = std::to_string(port)};
}

IntegratorOptions parse_integrator(const OptionValue& value) {
  if (value.text == "flat") return FlatOptions{};
  if (value.text == "path") return PathOptions{};
  if (const auto aov = aov_named(value.text)) return *aov;
  value.refuse(listed(integrator_names()));
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names{"flat", "path"};
  add_names(names, kAovs);
  return names;
}

Channels parse_aovs(const OptionValue& value) {
  Channels channels;
  const auto add = [&](auto& list, auto aov) {
    if (std::ranges::find(list, aov) != list.end())
      refuse_usage(value.option + ": names " + std::string(name_of(aov)) + " twice");
    list.push_back(aov);
  };
  for (const std::string_view name : split_at_commas(value.text)) {
    if (const auto aov = aov_named(name)) {
      add(channels.exact, *aov);
    } else if (const auto sampled = sampled_aov_named(name)) {
      add(channels.sampled, *sampled);
    } else {
      value.refuse("a comma-separated list of " + listed(aov_names()));
    }
  }
  return channels;
}

std::vector<std::string> aov_names() {
  std::vector<std::string> names;
  add_names(names, kAovs);
  add_names(names, kSampledAovs);
  return names;
}

}  // namespace microtrace::cli
