#pragma once
/// Parses option values that have their own notation.

#include "cli/options/option_value.hpp"

#include <microtrace/aov.hpp>
#include <microtrace/defaults.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/film.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/math.hpp>
#include <microtrace/ray.hpp>
#include <microtrace/sampled_aov.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace microtrace::cli {

// Each parse_ function that takes an OptionValue throws Error (usage) with the option's name and
// the values that it accepts.

/// Parses WIDTHxHEIGHT.
[[nodiscard]] ImageSize parse_size(const OptionValue& value);
/// Checks NAME or NAME:PORT. A name has letters, digits, '.' and '-', or is an IPv6 address in
/// brackets, so that the text may become part of a header field.
[[nodiscard]] std::string parse_host(const OptionValue& value);

/// Parses x0,y0,x1,y1.
[[nodiscard]] PixelRect parse_crop(const OptionValue& value);

/// Parses x,y, where 0,0 is the center of the first pixel. Returns pixel coordinates as in
/// RayGenerator.
[[nodiscard]] DVec2 parse_pixel(const OptionValue& value);
/// A ray in world space, where float32 may be too coarse for origins.
struct WorldRay {
  DVec3 o{0};
  Vec3 d{0, 0, 1};
  float t_min = Ray{}.t_min, t_max = Ray{}.t_max;

  /// The ray in the coordinates of a scene with this origin.
  [[nodiscard]] Ray in_scene(const DVec3& origin) const {
    return {.o = Vec3(o - origin), .t_min = t_min, .d = d, .t_max = t_max};
  }
};
/// Parses ox,oy,oz,dx,dy,dz or, with the interval, ox,oy,oz,dx,dy,dz,t_min,t_max.
[[nodiscard]] WorldRay parse_ray(const OptionValue& value);

/// The viewing direction of --view.
struct OrbitView {
  View view{};
  std::optional<double> distance{};  ///< from the target; absent: the camera frames the whole scene
};

/// Parses the name of a side; or AZIMUTH,ELEVATION in degrees; or AZIMUTH,ELEVATION,DISTANCE.
[[nodiscard]] OrbitView parse_view(const OptionValue& value);
[[nodiscard]] std::vector<std::string> view_names();

/// The background behind all objects.
struct Background {
  enum class Kind { color, transparent, environment } kind = Kind::color;
  Vec3 color{0};  ///< linear Rec. 709; black for the other kinds
};

/// Parses #rrggbb in sRGB; or red,green,blue in linear light, each in [0, 1]; or "transparent" or
/// "env".
[[nodiscard]] Background parse_background(const OptionValue& value);
/// Parses #rrggbb in sRGB; or red,green,blue in linear light, each in [0, kMaxRadiance]. Returns
/// nothing for any other text.
[[nodiscard]] std::optional<Vec3> parse_radiance(const std::string& text);

/// Uniform radiance, the built-in studio, or the path of an environment map.
using EnvironmentSource = std::variant<Vec3, Studio, std::filesystem::path>;

/// Parses a color as parse_radiance() does, "studio", or a path.
[[nodiscard]] EnvironmentSource parse_environment(const OptionValue& value);

/// Part `index` of `count`, counted from 1.
struct Shard {
  std::uint32_t index = 1, count = 1;
};

/// Parses I/N.
[[nodiscard]] Shard parse_shard(const OptionValue& value);

/// A port of a machine, for getaddrinfo().
struct NetworkAddress {
  std::string host{}, port{};
};

/// Parses HOST:PORT, where HOST is a name, an IPv4 address, or an IPv6 address in brackets.
[[nodiscard]] NetworkAddress parse_address(const OptionValue& value);

[[nodiscard]] IntegratorOptions parse_integrator(const OptionValue& value);
[[nodiscard]] std::vector<std::string> integrator_names();

/// The channels of --aov.
struct Channels {
  std::vector<Aov> exact{};
  std::vector<SampledAov> sampled{};

  [[nodiscard]] bool empty() const { return exact.empty() && sampled.empty(); }
};

/// Parses comma-separated names of quantities, each of which may appear once.
[[nodiscard]] Channels parse_aovs(const OptionValue& value);
[[nodiscard]] std::vector<std::string> aov_names();

}  // namespace microtrace::cli
