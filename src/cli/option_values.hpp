#pragma once
/// What stands behind options on the command line.

#include <microtrace/aov.hpp>
#include <microtrace/film.hpp>
#include <microtrace/framing.hpp>
#include <microtrace/math.hpp>
#include <microtrace/sampled_aov.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace microtrace::cli {

/// Decimal digits alone, without sign.
[[nodiscard]] std::optional<std::uint32_t> whole_number(std::string_view text);

// Each throws CLI::ValidationError, which names the option and what it wants.

/// WIDTHxHEIGHT
[[nodiscard]] ImageSize parse_size(const std::string& text);
/// x0,y0,x1,y1
[[nodiscard]] PixelRect parse_crop(const std::string& text);

/// Where --view looks from.
struct OrbitView {
  View view{};
  std::optional<double> distance{};  ///< from what is looked at; absent: the whole scene is framed
};

/// A side's name, or AZIMUTH,ELEVATION in degrees, or with a distance AZIMUTH,ELEVATION,DISTANCE
[[nodiscard]] OrbitView parse_view(const std::string& text);
/// Three finite numbers
[[nodiscard]] DVec3 parse_point(const char* option, const std::string& text);
/// A finite number
[[nodiscard]] double parse_number(const char* option, const std::string& text);

/// Bytes, above 0: a whole number, or one with K, M or G behind it for so many KiB, MiB or GiB
[[nodiscard]] std::uint64_t parse_bytes(const char* option, const std::string& text);

/// What lies behind all objects.
struct Background {
  enum class Kind { color, transparent, environment } kind = Kind::color;
  Vec3 color{0};  ///< linear Rec. 709; black unless it is of that kind
};

/// #rrggbb in sRGB; or red,green,blue in linear light, each in [0, 1]; or "transparent" or "env"
[[nodiscard]] Background parse_background(const std::string& text);
/// #rrggbb in sRGB; or red,green,blue in linear light, each in [0, kMaxRadiance]; else nothing
[[nodiscard]] std::optional<Vec3> parse_radiance(const std::string& text);

/// How colours come about.
enum class Technique { flat, path };
/// What a picture shows: colours, or a quantity.
using Subject = std::variant<Technique, Aov>;

/// A technique's or a quantity's name
[[nodiscard]] Subject parse_integrator(const std::string& text);
/// What --aov names.
struct Channels {
  std::vector<Aov> exact{};
  std::vector<SampledAov> sampled{};

  [[nodiscard]] bool empty() const { return exact.empty() && sampled.empty(); }
};

/// Names of quantities with commas between them, each once
[[nodiscard]] Channels parse_aovs(const std::string& text);

/// The words that an option takes, of which shells offer a choice; none for free text.
[[nodiscard]] std::vector<std::string> words_of(std::string_view option);

}  // namespace microtrace::cli
