#include "cli/option_values.hpp"

#include "scene/srgb.hpp"
#include "scene/validate.hpp"

#include <microtrace/environment.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <CLI/Error.hpp>

namespace microtrace::cli {
namespace {

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    parts.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

/// All of the text as a number; `format` is an integer's base.
template <typename Number, typename... Format>
std::optional<Number> read(std::string_view text, Format... format) {
  Number value{};
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, format...);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Finite numbers with commas between; none where the text is something else.
std::vector<double> read_all(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text)) {
    const auto number = read<double>(part);
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

std::string aov_names() {
  std::string names;
  for (const Aov aov : kAovs) names.append(names.empty() ? "" : ", ").append(name_of(aov));
  return names;
}

/// #rrggbb in sRGB, or three numbers in [0, greatest].
std::optional<Vec3> parse_color(const std::string& text, float greatest) {
  const std::vector<std::string_view> parts = split(text);
  Vec3 color(0);
  bool good = false;
  if (text.size() == 7 && text[0] == '#') {
    const std::string_view digits = std::string_view(text).substr(1);
    good = digits.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
    for (glm::length_t i = 0; good && i < 3; ++i) {
      const auto code =
          read<std::uint8_t>(digits.substr(2 * static_cast<std::size_t>(i), 2), 16).value_or(0);
      color[i] = static_cast<float>(linear_from_srgb(code / 255.0));
    }
  } else if (parts.size() == 3) {
    good = true;
    for (glm::length_t i = 0; i < 3; ++i) {
      const auto value = read<float>(parts[static_cast<std::size_t>(i)]);
      good = good && value && *value >= 0 && *value <= greatest;
      color[i] = value.value_or(0);
    }
  }
  return good ? std::optional(color) : std::nullopt;
}

constexpr std::array<std::pair<std::string_view, View>, 7> kViews{{
    {"front", {.azimuth = 0, .elevation = 0}},
    {"right", {.azimuth = 90, .elevation = 0}},
    {"back", {.azimuth = 180, .elevation = 0}},
    {"left", {.azimuth = 270, .elevation = 0}},
    {"top", {.azimuth = 0, .elevation = 90}},
    {"bottom", {.azimuth = 0, .elevation = -90}},
    // Looks along a cube's diagonal: sin^2 = 1/3.
    {"iso", {.azimuth = 45, .elevation = 35.264389682754654}},
}};

}  // namespace

std::optional<std::uint32_t> whole_number(std::string_view text) {
  return read<std::uint32_t>(text);
}

ImageSize parse_size(const std::string& text) {
  const std::size_t x = text.find('x');
  const auto width = whole_number(std::string_view(text).substr(0, x));
  const auto height =
      x == std::string::npos ? std::nullopt : whole_number(std::string_view(text).substr(x + 1));
  if (!width || !height)
    throw CLI::ValidationError("--size", "wants WIDTHxHEIGHT in pixels, as 640x480, not " + text);
  const ImageSize size{.width = *width, .height = *height};
  if (const auto problem = validate(size))
    throw CLI::ValidationError("--size", problem->field + " " + problem->message);
  return size;
}

PixelRect parse_crop(const std::string& text) {
  std::array<std::uint32_t, 4> sides{};
  const std::vector<std::string_view> parts = split(text);
  bool good = parts.size() == sides.size();
  for (std::size_t i = 0; good && i < sides.size(); ++i) {
    const auto side = whole_number(parts[i]);
    good = side.has_value();
    sides[i] = side.value_or(0);
  }
  if (!good) throw CLI::ValidationError("--crop", "wants x0,y0,x1,y1 in pixels, not " + text);
  return {.x0 = sides[0], .y0 = sides[1], .x1 = sides[2], .y1 = sides[3]};
}

OrbitView parse_view(const std::string& text) {
  for (const auto& [name, view] : kViews) {
    if (name == text) return {.view = view};
  }
  const std::vector<double> numbers = read_all(text);
  const bool is_round = numbers.size() == 2 || (numbers.size() == 3 && numbers[2] > 0);
  if (is_round && std::abs(numbers[1]) <= 90) {
    OrbitView orbit{.view = {.azimuth = numbers[0], .elevation = numbers[1]}};
    if (numbers.size() == 3) orbit.distance = numbers[2];
    return orbit;
  }
  std::string names;
  for (const auto& [name, view] : kViews) names.append(name).append(", ");
  throw CLI::ValidationError("--view", "wants " + names +
                                           "or AZIMUTH,ELEVATION in degrees, elevation from -90 "
                                           "to 90, or both and a distance above 0, not " +
                                           text);
}

DVec3 parse_point(const char* option, const std::string& text) {
  const std::vector<double> numbers = read_all(text);
  if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
  throw CLI::ValidationError(option, "wants three numbers x,y,z, not " + text);
}

Background parse_background(const std::string& text) {
  if (text == "transparent") return {.kind = Background::Kind::transparent};
  if (text == "env") return {.kind = Background::Kind::environment};
  if (const auto color = parse_color(text, 1)) return {.color = *color};
  throw CLI::ValidationError("--background",
                             "wants transparent, env, #rrggbb (sRGB), or three numbers from 0 to 1 "
                             "(linear light) as 0.2,0.4,1, not " +
                                 text);
}

std::optional<Vec3> parse_radiance(const std::string& text) {
  return parse_color(text, kMaxRadiance);
}

Subject parse_integrator(const std::string& text) {
  if (text == "flat") return Technique::flat;
  if (text == "path") return Technique::path;
  if (const auto aov = aov_named(text)) return *aov;
  throw CLI::ValidationError("--integrator", "wants flat, path, " + aov_names() + ", not " + text);
}

Channels parse_aovs(const std::string& text) {
  Channels channels;
  const auto add = [](auto& list, auto aov) {
    if (std::ranges::find(list, aov) != list.end())
      throw CLI::ValidationError("--aov", "names " + std::string(name_of(aov)) + " twice");
    list.push_back(aov);
  };
  for (const std::string_view name : split(text)) {
    if (const auto aov = aov_named(name)) {
      add(channels.exact, *aov);
    } else if (const auto sampled = sampled_aov_named(name)) {
      add(channels.sampled, *sampled);
    } else {
      std::string names = aov_names();
      for (const SampledAov other : kSampledAovs) names.append(", ").append(name_of(other));
      throw CLI::ValidationError("--aov",
                                 "wants names from " + names + " with commas between, not " + text);
    }
  }
  return channels;
}

double parse_number(const char* option, const std::string& text) {
  const auto value = read<double>(text);
  if (!value || !std::isfinite(*value))
    throw CLI::ValidationError(option, "wants a number, not " + text);
  return *value;
}

std::uint64_t parse_bytes(const char* option, const std::string& text) {
  constexpr std::string_view units = "KMG";
  const std::size_t unit = text.empty() ? units.npos : units.find(text.back());
  const bool has_unit = unit != units.npos;
  const auto number =
      read<std::uint64_t>(std::string_view(text).substr(0, text.size() - (has_unit ? 1 : 0)));
  const std::size_t shift = has_unit ? 10 * (unit + 1) : 0;
  if (!number || *number == 0 || *number > std::numeric_limits<std::uint64_t>::max() >> shift) {
    throw CLI::ValidationError(
        option,
        "wants a number of bytes above 0, or of KiB, MiB or GiB as in 512M or 4G, not " + text);
  }
  return *number << shift;
}

std::vector<std::string> words_of(std::string_view option) {
  std::vector<std::string> words;
  const auto add_names = [&](const auto& values) {
    for (const auto value : values) words.emplace_back(name_of(value));
  };
  if (option == "--integrator") words = {"flat", "path"};
  if (option == "--integrator" || option == "--aov") add_names(kAovs);
  if (option == "--aov") add_names(kSampledAovs);
  if (option == "--tonemap") add_names(kToneMaps);
  if (option == "--view") {
    for (const auto& [name, view] : kViews) words.emplace_back(name);
  }
  if (option == "--background") words = {"env", "transparent"};
  if (option == "--env") words = {"studio"};
  if (option == "--filter") words = {"box", "blackman-harris"};
  if (option == "--backfaces") words = {"pass", "occlude"};
  if (option == "--ppm") words = {"binary", "ascii"};
  if (option == "--progress") words = {"bar", "json", "none"};
  return words;
}

}  // namespace microtrace::cli
